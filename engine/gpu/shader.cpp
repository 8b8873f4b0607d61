// Embedded shaders and .spv files.

#include "engine/gpu/shader.h"

#include "engine/base/error.h"
#include "engine/base/files.h"

#include <cstring>

// Written by the build (CMakeLists.txt); closed by a null name. Names end in ".texel" or ".storage".
struct EmbeddedShader {
    const char* name;
    const std::byte* begin;
    const std::byte* end;
};
extern "C" const EmbeddedShader embeddedShaderTable[];

namespace gpu
{

namespace
{

std::vector<uint32_t> wordsOf(std::span<const std::byte> bytes)
{
    std::vector<uint32_t> words(bytes.size() / sizeof(uint32_t));
    std::memcpy(words.data(), bytes.data(), words.size() * sizeof(uint32_t));
    return words;
}

} // namespace

std::vector<uint32_t> loadShader(const std::string& name, bool tablesAreTexelBuffers)
{
    const std::string flavored = name + (tablesAreTexelBuffers ? ".texel" : ".storage");
    if (name.find('/') != std::string::npos) return wordsOf(files::read(flavored + ".spv"));
    for (const EmbeddedShader* shader = embeddedShaderTable; shader->name; ++shader)
        if (flavored == shader->name) return wordsOf({shader->begin, shader->end});
    throw Error("There is no shader \"{}\" in this program.", name);
}

} // namespace gpu
