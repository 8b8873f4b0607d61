#include "engine/scene/gltf_uri.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/scene/gltf_json.h"

namespace scene::gltf
{

namespace
{

constexpr uint64_t MAX_FILE_BYTES = uint64_t{1} << 31;
constexpr size_t MAX_PATH_LENGTH = 4096;

int hexDigit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

// RFC 3986, 2.1.
std::string decodePercent(const std::string& uri)
{
    std::string text;
    for (size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] != '%') {
            text += uri[i];
            continue;
        }
        const int high = i + 2 < uri.size() ? hexDigit(uri[i + 1]) : -1;
        const int low = high >= 0 ? hexDigit(uri[i + 2]) : -1;
        if (low < 0)
            throw Error("The URI \"{}\" has a '%' that is not followed by two hexadecimal digits.", shown(uri));
        text += static_cast<char>(16 * high + low);
        i += 2;
    }
    return text;
}

// RFC 3986, 3.1: letters, digits, "+-." up to a colon.
bool hasScheme(const std::string& uri)
{
    const size_t colon = uri.find(':');
    if (colon == std::string::npos || colon == 0 || !std::isalpha(static_cast<unsigned char>(uri[0]))) return false;
    return std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon),
                       [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '-' || c == '.'; });
}

std::vector<std::byte> readDataUri(const std::string& uri)
{
    const size_t comma = uri.find(',');
    if (comma == std::string::npos) throw Error("The data URI \"{}\" has no comma.", shown(uri));
    if (!std::string_view(uri).substr(0, comma).ends_with(";base64"))
        throw Error("The data URI \"{}\" is not encoded in base64.", shown(uri));
    return decodeBase64(std::string_view(uri).substr(comma + 1));
}

bool isInside(const std::filesystem::path& path, const std::filesystem::path& folder)
{
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

std::filesystem::path canonicalFolder(const std::filesystem::path& folder)
{
    std::error_code failure;
    const std::filesystem::path canonical = std::filesystem::canonical(folder, failure);
    if (failure || !std::filesystem::is_directory(canonical))
        throw Error("Cannot find the folder \"{}\".", folder.string());
    return canonical;
}

} // namespace

std::vector<std::byte> decodeBase64(std::string_view text)
{
    static const auto VALUES = [] {
        std::array<int, 256> values;
        values.fill(-1);
        const std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        for (size_t i = 0; i < digits.size(); ++i) values[static_cast<unsigned char>(digits[i])] = static_cast<int>(i);
        return values;
    }();

    const size_t end = std::min(text.find_last_not_of('=') + 1, text.size());
    const size_t padding = text.size() - end;
    if (end % 4 == 1 || padding > 2 || (padding > 0 && text.size() % 4 != 0))
        throw Error("Base64 data of {} characters is cut short or wrongly padded.", text.size());
    std::vector<std::byte> bytes;
    bytes.reserve(end / 4 * 3 + 2);
    uint32_t bits = 0;
    for (size_t i = 0; i < end; ++i) {
        const int value = VALUES[static_cast<unsigned char>(text[i])];
        if (value < 0) throw Error("Base64 data has an invalid character at position {}.", i);
        bits = bits << 6 | static_cast<uint32_t>(value);
        const size_t phase = i % 4; // the characters of a group of four complete no byte, then one each
        if (phase > 0) bytes.push_back(static_cast<std::byte>(bits >> (6 - 2 * phase) & 0xff));
    }
    return bytes;
}

std::optional<std::filesystem::path> fileOf(const std::string& uri, const Folders& folders)
{
    if (uri.starts_with("data:")) return std::nullopt;
    if (hasScheme(uri)) throw Error("The URI \"{}\" has a scheme; only data: and relative paths are read.", shown(uri));
    const std::string relative = decodePercent(uri);
    if (relative.empty()) throw Error("A URI is empty.");
    if (relative.size() > MAX_PATH_LENGTH) throw Error("The URI \"{}\" is {} bytes long.", shown(uri), uri.size());
    if (relative.find('\0') != std::string::npos) throw Error("The URI \"{}\" contains a NUL.", shown(uri));

    const std::filesystem::path own = canonicalFolder(folders.own.empty() ? "." : folders.own);
    const std::filesystem::path root = folders.root.empty() ? own : canonicalFolder(folders.root);
    const bool absolute = std::filesystem::path(relative).is_absolute();
    const auto requireAllowed = [&](const std::filesystem::path& file) {
        if (!absolute && (isInside(file, own) || isInside(file, root))) return;
        throw Error("The URI \"{}\" leads out of the asset's folder{}.", shown(uri),
                    folders.root.empty() ? "; --asset-root DIR lets files lie anywhere below DIR"
                                         : fmt::format(" and out of --asset-root \"{}\"", folders.root.string()));
    };
    // By its words first, so that the answer does not depend on what exists outside; then for links that lead out.
    requireAllowed((own / relative).lexically_normal());
    std::error_code failure;
    const std::filesystem::path target = std::filesystem::canonical(own / relative, failure);
    if (failure) throw Error("Cannot read \"{}\": {}.", shown(relative), failure.message());
    requireAllowed(target);
    return target;
}

std::vector<std::byte> readUri(const std::string& uri, const Folders& folders)
{
    const std::optional<std::filesystem::path> file = fileOf(uri, folders);
    return file ? files::read(*file, MAX_FILE_BYTES) : readDataUri(uri);
}

} // namespace scene::gltf
