#include "engine/base/files.h"

#include "engine/base/error.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <unistd.h>

namespace files
{

namespace
{

struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

} // namespace

std::vector<std::byte> read(const std::filesystem::path& path, uint64_t maxBytes)
{
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) throw Error("Cannot read \"{}\": no such file.", path.string());
    if (!std::filesystem::is_regular_file(path, ignored))
        throw Error("Cannot read \"{}\": not a regular file.", path.string());
    const uint64_t size = std::filesystem::file_size(path, ignored);
    if (size > maxBytes)
        throw Error("Cannot read \"{}\": {} bytes, more than the limit of {}.", path.string(), size, maxBytes);

    const File file(std::fopen(path.c_str(), "rb"));
    if (!file) throw Error("Cannot read \"{}\": {}.", path.string(), std::strerror(errno));
    std::vector<std::byte> bytes(size);
    const size_t got = std::fread(bytes.data(), 1, bytes.size(), file.get());
    if (got != bytes.size()) throw Error("Cannot read \"{}\": got {} of {} bytes.", path.string(), got, size);
    return bytes;
}

void writeAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes)
{
    std::filesystem::path temporary = path;
    temporary += fmt::format(".{}.tmp", ::getpid());
    const auto fail = [&](const char* what) -> Error {
        const int reason = errno;
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        return Error("Cannot write \"{}\": {} ({}).", path.string(), what, std::strerror(reason));
    };

    File file(std::fopen(temporary.c_str(), "wb"));
    if (!file) throw fail("cannot create a file there");
    if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) throw fail("short write");
    if (std::fflush(file.get()) != 0) throw fail("short write");
    if (std::fclose(file.release()) != 0) throw fail("cannot close");
    if (std::rename(temporary.c_str(), path.c_str()) != 0) throw fail("cannot rename into place");
}

} // namespace files
