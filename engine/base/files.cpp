#include "engine/base/files.h"

#include "engine/base/error.h"

#include <algorithm>
#include <cctype>
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

constexpr int MAX_LINKS = 40; // as Linux follows

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

// False: errno says why.
bool writeAll(int descriptor, std::span<const Bytes> pieces)
{
    for (Bytes piece : pieces)
        while (!piece.empty()) {
            const ssize_t written = ::write(descriptor, piece.data(), piece.size());
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) return false;
            piece = piece.subspan(size_t(written));
        }
    return true;
}

Error failure(const std::filesystem::path& path, const char* what, int reason)
{
    return Error("Cannot write \"{}\": {} ({}).", path.string(), what, std::strerror(reason));
}

void writeToDevice(const std::filesystem::path& path, std::span<const Bytes> pieces)
{
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC, 0);
    if (descriptor < 0) throw failure(path, "cannot open it", errno);
    const bool whole = writeAll(descriptor, pieces);
    const int reason = errno;
    ::close(descriptor);
    if (!whole) throw failure(path, "short write", reason);
}

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
    if (isDevice(path)) return writeToDevice(path, pieces);
    const std::filesystem::path file = resolved(path);
    std::filesystem::path temporary = file;
    temporary += fmt::format(".{}.tmp", ::getpid());
    const auto fail = [&](const char* what) -> Error {
        const int reason = errno;
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        return failure(path, what, reason);
    };

    const Target target(temporary);
    if (!target.opened()) throw fail("cannot create a file there");
    if (!writeAll(target.descriptor(), pieces)) throw fail("short write");
    if (::fsync(target.descriptor()) != 0) throw fail("cannot bring it to the disk");
    if (!target.name()) throw fail("cannot name the file");
    if (std::rename(temporary.c_str(), file.c_str()) != 0) throw fail("cannot rename into place");
}

void createFolder(const std::filesystem::path& path)
{
    std::error_code failure;
    std::filesystem::create_directories(path, failure);
    if (failure) throw Error("Cannot create the folder \"{}\": {}.", path.string(), failure.message());
}

std::filesystem::path resolved(const std::filesystem::path& path)
{
    std::filesystem::path file = path;
    std::error_code failed;
    for (int links = 0; links < MAX_LINKS && std::filesystem::is_symlink(file, failed); ++links) {
        const std::filesystem::path target = std::filesystem::read_symlink(file, failed);
        if (failed) break;
        file = file.parent_path() / target; // an absolute one stands alone
    }
    if (std::filesystem::is_symlink(file, failed))
        throw Error("Cannot follow the symbolic link \"{}\": it leads to no end.", path.string());
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    const std::filesystem::path real = std::filesystem::weakly_canonical(folder, failed);
    return failed ? file : real / file.filename();
}

bool isDevice(const std::filesystem::path& path)
{
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(path, ignored);
    return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
           !std::filesystem::is_directory(status);
}

bool areSame(const std::filesystem::path& a, const std::filesystem::path& b)
{
    if (isDevice(a) || isDevice(b)) return false;
    std::error_code ignored; // of what is not there
    return std::filesystem::equivalent(a, b, ignored) || resolved(a) == resolved(b);
}

std::string extensionOf(const std::filesystem::path& path)
{
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return extension;
}

} // namespace files
