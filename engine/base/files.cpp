#include "engine/base/files.h"

#include "engine/base/error.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
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

// A file to be written, without a name where the file system has such: then nothing is left of it unless name() is
// reached, whatever ends the process.
class Target
{
  public:
    explicit Target(const std::filesystem::path& name) : name_(name)
    {
        const std::filesystem::path folder = name.has_parent_path() ? name.parent_path() : ".";
        if (::access("/proc/self/fd", X_OK) == 0) // by which it gets its name
            descriptor_ = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
        nameless_ = descriptor_ >= 0;
        if (!nameless_) descriptor_ = ::open(name.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0666);
    }
    ~Target()
    {
        if (opened()) ::close(descriptor_);
    }
    Target(const Target&) = delete;
    Target& operator=(const Target&) = delete;

    bool opened() const { return descriptor_ >= 0; }
    int descriptor() const { return descriptor_; }
    bool name() const
    {
        if (!nameless_) return true;
        ::unlink(name_.c_str()); // of a dead process with our number
        const std::string source = fmt::format("/proc/self/fd/{}", descriptor_);
        return ::linkat(AT_FDCWD, source.c_str(), AT_FDCWD, name_.c_str(), AT_SYMLINK_FOLLOW) == 0;
    }

  private:
    std::filesystem::path name_;
    int descriptor_ = -1;
    bool nameless_ = false;
};

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

void writeAtomically(const std::filesystem::path& path, Bytes bytes)
{
    writeAtomically(path, std::span(&bytes, 1));
}

void writeAtomically(const std::filesystem::path& path, std::span<const Bytes> pieces)
{
    std::filesystem::path temporary = path;
    temporary += fmt::format(".{}.tmp", ::getpid());
    const auto fail = [&](const char* what) -> Error {
        const int reason = errno;
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        return Error("Cannot write \"{}\": {} ({}).", path.string(), what, std::strerror(reason));
    };

    const Target target(temporary);
    if (!target.opened()) throw fail("cannot create a file there");
    for (Bytes piece : pieces)
        while (!piece.empty()) {
            const ssize_t written = ::write(target.descriptor(), piece.data(), piece.size());
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) throw fail("short write");
            piece = piece.subspan(size_t(written));
        }
    if (::fsync(target.descriptor()) != 0) throw fail("cannot bring it to the disk");
    if (!target.name()) throw fail("cannot name the file");
    if (std::rename(temporary.c_str(), path.c_str()) != 0) throw fail("cannot rename into place");
}

} // namespace files
