#pragma once
// Decodes the pictures of materials: PNG or JPEG, told apart by their first bytes.

#include <cstddef>
#include <span>
#include <string>

#include "engine/scene/scene.h"

namespace scene
{

constexpr uint32_t MAX_TEXTURE_SIDE = 65535; // sizes share 32 bits on the device

// Any bit depth and channel count becomes RGBA of 8 bits; of 16, where a PNG has them and 8 would not hold each sample
// exactly. Throws Error: other format, malformed, cut short, more than 2^28 pixels, or larger than `bytes` could hold.
// `name` is for messages and becomes Image::name.
Image decodeTexture(std::span<const std::byte> bytes, const std::string& name);

} // namespace scene
