// GLSL to SPIR-V at run time, through glslang's library.

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/gpu/shader.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

namespace gpu
{

namespace
{

constexpr uint64_t MAX_SOURCE_BYTES = 16 << 20;

std::string readText(const std::filesystem::path& path)
{
    const std::vector<std::byte> bytes = files::read(path, MAX_SOURCE_BYTES);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// #include "name": beside the including file, then in each folder.
class Includer : public glslang::TShader::Includer
{
  public:
    explicit Includer(std::vector<std::filesystem::path> folders) : folders_(std::move(folders)) {}

    IncludeResult* includeLocal(const char* name, const char* includer, size_t depth) override
    {
        const std::filesystem::path neighbor = std::filesystem::path(includer).parent_path() / name;
        return std::filesystem::is_regular_file(neighbor) ? load(neighbor) : includeSystem(name, includer, depth);
    }
    IncludeResult* includeSystem(const char* name, const char*, size_t) override
    {
        for (const std::filesystem::path& folder : folders_)
            if (std::filesystem::is_regular_file(folder / name)) return load(folder / name);
        return nullptr;
    }
    void releaseInclude(IncludeResult* result) override
    {
        if (!result) return;
        delete static_cast<std::string*>(result->userData);
        delete result;
    }

  private:
    static IncludeResult* load(const std::filesystem::path& path)
    {
        auto text = std::make_unique<std::string>(readText(path));
        auto* result = new IncludeResult(path.string(), text->data(), text->size(), text.get());
        static_cast<void>(text.release()); // until releaseInclude
        return result;
    }
    std::vector<std::filesystem::path> folders_;
};

} // namespace

std::vector<uint32_t> compileShader(const std::filesystem::path& source, const std::filesystem::path& directory,
                                    bool tablesAreTexelBuffers)
{
    static const bool initialized = glslang::InitializeProcess();
    if (!initialized) throw Error("The GLSL compiler does not start.");

    const std::string text = readText(source);
    const std::string path = source.string();
    const char* textPointer = text.c_str();
    const int length = int(text.size());
    const char* name = path.c_str();
    glslang::TShader shader(EShLangCompute);
    shader.setStringsWithLengthsAndNames(&textPointer, &length, &name, 1);
    shader.setPreamble(tablesAreTexelBuffers ? "" : "#define TABLES_IN_STORAGE\n");
    shader.setEnvInput(glslang::EShSourceGlsl, EShLangCompute, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_2);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_5);

    Includer includer({directory, directory / "path"});
    const auto messages = EShMessages(EShMsgSpvRules | EShMsgVulkanRules);
    if (!shader.parse(GetDefaultResources(), 100, false, messages, includer))
        throw Error("Shader \"{}\" does not compile:\n{}", path, shader.getInfoLog());
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(messages)) throw Error("Shader \"{}\" does not link:\n{}", path, program.getInfoLog());
    std::vector<uint32_t> spirv;
    glslang::GlslangToSpv(*program.getIntermediate(EShLangCompute), spirv);
    return spirv;
}

} // namespace gpu
