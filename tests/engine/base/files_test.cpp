#include "engine/base/error.h"
#include "engine/base/files.h"

#include <gtest/gtest.h>

#include <filesystem>

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

TEST(Files, WritingIntoAMissingFolderIsAnErrorAndLeavesNothing)
{
    EXPECT_THROW(files::writeAtomically("/nonexistent/x", files::Bytes()), Error);
    EXPECT_THROW(files::read("/dev/zero"), Error);
}
