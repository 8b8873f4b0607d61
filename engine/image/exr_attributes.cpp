#include "engine/image/exr_attributes.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/shown.h"

namespace image
{

namespace
{

constexpr size_t HEADERS_BEGIN = 8;                    // after magic number and version
constexpr std::byte MANY_PARTS{1 << (12 - 8)};         // bit 12 of the version
constexpr size_t VERSION_FLAGS = 5;                    // the byte that holds it
constexpr size_t CHANNEL_BYTES = 16;                   // after its name
constexpr size_t PREVIEW_SIZES = 8, PREVIEW_PIXEL = 4; // bytes

// Bytes of a value, by type: as OpenEXR's file layout has it.
constexpr std::pair<std::string_view, size_t> FIXED[] = {{"box2f", 16},
                                                         {"box2i", 16},
                                                         {"chromaticities", 32},
                                                         {"compression", 1},
                                                         {"deepImageState", 1},
                                                         {"double", 8},
                                                         {"envmap", 1},
                                                         {"float", 4},
                                                         {"int", 4},
                                                         {"keycode", 28},
                                                         {"lineOrder", 1},
                                                         {"m33d", 72},
                                                         {"m33f", 36},
                                                         {"m44d", 128},
                                                         {"m44f", 64},
                                                         {"rational", 8},
                                                         {"tiledesc", 9},
                                                         {"timecode", 8},
                                                         {"v2d", 16},
                                                         {"v2f", 8},
                                                         {"v2i", 8},
                                                         {"v3d", 24},
                                                         {"v3f", 12},
                                                         {"v3i", 12}};

// Reads on from the front. Throws Error, of which `what` is the beginning, where the bytes end too soon.
class Reader
{
  public:
    Reader(std::span<const std::byte> bytes, const std::string& what) : rest_(bytes), what_(what) {}

    bool empty() const { return rest_.empty(); }
    bool atZero() const { return !empty() && rest_.front() == std::byte{0}; }

    std::span<const std::byte> take(size_t size)
    {
        if (size > rest_.size()) throw Error("{} is cut short, or claims to be longer than it is.", what_);
        const auto taken = rest_.first(size);
        rest_ = rest_.subspan(size);
        return taken;
    }
    uint32_t number()
    {
        uint32_t value = 0;
        std::memcpy(&value, take(sizeof(value)).data(), sizeof(value));
        return value;
    }
    std::string_view text() // up to a zero
    {
        const auto length = static_cast<size_t>(std::ranges::find(rest_, std::byte{0}) - rest_.begin());
        return {reinterpret_cast<const char*>(take(length + 1).data()), length};
    }

  private:
    std::span<const std::byte> rest_;
    const std::string& what_;
};

bool isAsLong(std::string_view type, std::span<const std::byte> value, const std::string& what)
{
    for (const auto& [name, size] : FIXED)
        if (type == name) return value.size() == size;
    Reader reader(value, what);
    if (type == "chlist") {
        while (!reader.text().empty()) reader.take(CHANNEL_BYTES);
        return reader.empty();
    }
    if (type == "stringvector") {
        while (!reader.empty()) reader.take(reader.number());
        return true;
    }
    if (type == "preview") {
        const uint64_t pixels = uint64_t{reader.number()} * reader.number();
        return pixels < value.size() && value.size() == PREVIEW_SIZES + PREVIEW_PIXEL * pixels;
    }
    if (type == "floatvector") return value.size() % sizeof(float) == 0;
    return type != "idmanifest"; // of deep pictures, and packed. What is left OpenEXR takes by its length.
}

} // namespace

void checkAttributes(std::span<const std::byte> bytes, const std::string& what)
{
    Reader reader(bytes, what);
    const bool manyParts = (reader.take(HEADERS_BEGIN)[VERSION_FLAGS] & MANY_PARTS) != std::byte{0};
    do {
        for (std::string_view name = reader.text(); !name.empty(); name = reader.text()) {
            const std::string_view type = reader.text();
            const std::string attribute = fmt::format("{}, attribute {},", what, shown(std::string(name)));
            const std::span<const std::byte> value = reader.take(reader.number());
            if (!isAsLong(type, value, attribute))
                throw Error("{} has {} bytes, which none of the type {} has.", attribute, value.size(),
                            shown(std::string(type)));
        }
    } while (manyParts && !reader.atZero());
}

} // namespace image
