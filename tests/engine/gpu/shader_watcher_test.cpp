#include "engine/gpu/shader_watcher.h"

#include "engine/base/error.h"
#include "engine/base/files.h"

#include <gtest/gtest.h>
#include <unistd.h>

namespace
{

namespace fs = std::filesystem;

TEST(ShaderWatcher, SeesChangesAdditionsAndRemovalsOnce)
{
    const fs::path folder = fs::temp_directory_path() / ("trichrome_watcher_" + std::to_string(::getpid()));
    fs::create_directories(folder / "lib");
    const auto write = [&](const char* name, std::string_view text) {
        files::writeAtomically(folder / name, std::as_bytes(std::span(text)));
    };
    write("a.comp", "a");
    write("lib/b.glsl", "b");
    gpu::ShaderWatcher watcher(folder);
    EXPECT_FALSE(watcher.changed());

    write("lib/b.glsl", "longer");
    EXPECT_TRUE(watcher.changed());
    EXPECT_FALSE(watcher.changed());

    fs::last_write_time(folder / "a.comp", fs::last_write_time(folder / "a.comp") + std::chrono::seconds(1));
    EXPECT_TRUE(watcher.changed()) << "equal size, later";

    write("lib/c.h", "c");
    EXPECT_TRUE(watcher.changed());
    fs::remove(folder / "lib/c.h");
    EXPECT_TRUE(watcher.changed());

    write("notes.txt", "not a shader");
    EXPECT_FALSE(watcher.changed());
    fs::remove_all(folder);
    EXPECT_THROW(gpu::ShaderWatcher{folder}, Error);
}

} // namespace
