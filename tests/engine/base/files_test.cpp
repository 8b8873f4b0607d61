#include "engine/base/error.h"
#include "engine/base/files.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <unistd.h>

TEST(Files, WriteThenReadGivesTheSameBytes)
{
    const auto path = std::filesystem::temp_directory_path() / "trichrome_files_test.bin";
    const std::vector<std::byte> bytes = {std::byte{1}, std::byte{0}, std::byte{255}};
    files::writeAtomically(path, bytes);
    EXPECT_EQ(files::read(path), bytes);
    EXPECT_THROW(files::read(path, 2), Error);
    const files::Bytes pieces[] = {std::span(bytes).first(1), {}, std::span(bytes).subspan(1)};
    files::writeAtomically(path, pieces);
    EXPECT_EQ(files::read(path), bytes);
    std::filesystem::remove(path);
    EXPECT_THROW(files::read(path), Error);
}

namespace
{

struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("trichrome_files_" + std::to_string(getpid()));
    Folder() { std::filesystem::create_directories(path / "inner"); }
    ~Folder() { std::filesystem::remove_all(path); }
    std::filesystem::path operator/(const char* name) const { return path / name; }
};

const std::vector<std::byte> BYTES = {std::byte{1}, std::byte{2}};

} // namespace

TEST(Files, ALinkStaysOneAndWhatItLeadsToIsWritten)
{
    const Folder folder;
    files::writeAtomically(folder / "target", files::Bytes());
    std::filesystem::create_symlink("target", folder / "link");
    std::filesystem::create_symlink("../link", folder / "inner/second");
    std::filesystem::create_symlink("inner/new", folder / "dangling");
    std::filesystem::create_symlink("circle", folder / "circle");
    files::writeAtomically(folder / "inner/second", BYTES);
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "inner/second") && std::filesystem::is_symlink(folder / "link"));
    EXPECT_EQ(files::read(folder / "target"), BYTES);
    files::writeAtomically(folder / "dangling", BYTES);
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "dangling"));
    EXPECT_EQ(files::read(folder / "inner/new"), BYTES);
    EXPECT_THROW(files::writeAtomically(folder / "circle", BYTES), Error);
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "circle"));
}

TEST(Files, WhatIsNoFileIsWrittenToAndStays)
{
    const Folder folder;
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    const int reader = open((folder / "pipe").c_str(), O_RDONLY | O_NONBLOCK);
    files::writeAtomically(folder / "pipe", BYTES);
    std::vector<std::byte> got(3);
    EXPECT_EQ(read(reader, got.data(), 3), 2);
    close(reader);
    EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe")); // as /dev/null would be, which a failure must not cost
}

TEST(Files, OneFileIsKnownByAllItsNames)
{
    const Folder folder;
    files::writeAtomically(folder / "a", BYTES);
    files::writeAtomically(folder / "b", BYTES);
    std::filesystem::create_symlink("a", folder / "link");
    std::filesystem::create_hard_link(folder / "a", folder / "hard");
    std::filesystem::create_symlink("new", folder / "dangling");
    std::filesystem::create_directory_symlink("inner", folder / "door");
    for (const char* name : {"a", "./a", "inner/../a", "link", "hard"})
        EXPECT_TRUE(files::areSame(folder / "a", folder / name)) << name;
    for (const char* name : {"b", "new", "inner", "inner/a"}) EXPECT_FALSE(files::areSame(folder / "a", folder / name));
    EXPECT_TRUE(files::areSame(folder / "new", folder / "dangling"));
    EXPECT_TRUE(files::areSame(folder / "inner/x", folder / "door/x"));
    EXPECT_TRUE(files::areSame("x", std::filesystem::current_path() / "x"));
    EXPECT_FALSE(files::areSame("/dev/null", "/dev/null"));
}

TEST(Files, ExtensionsAreInLowerCase)
{
    EXPECT_EQ(files::extensionOf("a/B.EXR"), ".exr");
    EXPECT_EQ(files::extensionOf("a.b/c"), "");
}

TEST(Files, WritingIntoAMissingFolderIsAnErrorAndLeavesNothing)
{
    EXPECT_THROW(files::writeAtomically("/nonexistent/x", files::Bytes()), Error);
    EXPECT_THROW(files::read("/dev/zero"), Error);
}
