// Compilation at run time, and the hot reload that it is for.

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/gpu/shader.h"
#include "engine/gpu/shader_watcher.h"
#include "tests/support/gpu_fixture.h"

#include <filesystem>

#include <fmt/core.h>

namespace
{

namespace fs = std::filesystem;
using Words = std::vector<uint32_t>;

class ShaderFolder : public GpuTest
{
  protected:
    void SetUp() override
    {
        GpuTest::SetUp();
        folder_ = fs::temp_directory_path() / ("trichrome_shaders_" + std::to_string(::getpid()));
        fs::create_directories(folder_ / "path");
    }
    void TearDown() override
    {
        fs::remove_all(folder_);
        GpuTest::TearDown();
    }
    void write(const std::string& name, const std::string& text) const
    {
        files::writeAtomically(folder_ / name, std::as_bytes(std::span(text)));
    }
    static std::string kernel(const std::string& expression)
    {
        return "#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"number.glsl\"\n"
               "layout(local_size_x = 1) in;\n"
               "layout(set = 0, binding = 0, std430) buffer Values { uint value; };\n"
               "void main() { value = " +
               expression + "; }\n";
    }

    fs::path folder_;
};

TEST_F(ShaderFolder, TheLibraryCompilesLikeTheBuild)
{
    const fs::path shaders = fs::path(TRICHROME_SOURCE_DIR) / "shaders";
    const fs::path tests = fs::path(TRICHROME_SOURCE_DIR) / "tests/engine/gpu";
    for (const char* name : {"pipeline_test", "limits_test", "table_test"})
        for (const bool texel : {true, false})
            EXPECT_EQ(gpu::compileShader(tests / (std::string(name) + ".comp"), shaders, texel),
                      gpu::loadShader(std::string(TEST_SPIRV_DIR "/") + name, texel))
                << name << texel;
}

TEST_F(ShaderFolder, ACompileErrorSaysFileAndLine)
{
    write("path/number.glsl", "const uint NUMBER = 1;\nconst uint OTHER = undefinedName;\n");
    write("broken.comp", kernel("NUMBER"));
    try {
        gpu::compileShader(folder_ / "broken.comp", folder_, true);
        FAIL() << "no error";
    } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("number.glsl:2"), std::string::npos) << message;
        EXPECT_NE(message.find("undefinedName"), std::string::npos) << message;
    }
    EXPECT_THROW(gpu::compileShader(folder_ / "absent.comp", folder_, true), Error);
    write("lost.comp", "#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"absent.glsl\"\n");
    EXPECT_THROW(gpu::compileShader(folder_ / "lost.comp", folder_, true), Error);
}

// Ten storage buffers a stage, as in WebGPU; tables apart.
// A table is a texel buffer that is loaded as an image and never written; no other image is known.
TEST_F(ShaderFolder, OnlyTablesMayBeImages)
{
    const auto reflect = [&](const std::string& image, const std::string& use) {
        write("image.comp", "#version 460\nlayout(local_size_x = 1) in;\n"
                            "layout(set = 0, binding = 0, std430) buffer Values { uint value; };\n" +
                                image + " Image;\nvoid main() { " + use + " }\n");
        return gpu::reflect(gpu::compileShader(folder_ / "image.comp", folder_, true), "image", true, {});
    };
    const std::string layout = "layout(set = 0, binding = 1, rgba32ui) uniform ";
    const std::string load = "value = imageLoad(Image, 0).x;";
    const gpu::Reflection table = reflect(layout + "readonly uimageBuffer", load);
    ASSERT_EQ(table.bindings.size(), 2u);
    EXPECT_EQ(table.bindings[1].kind, gpu::Binding::Kind::Table);
    EXPECT_TRUE(table.bindings[1].reads && !table.bindings[1].writes);
    const gpu::Reflection written = reflect(layout + "writeonly uimageBuffer", "imageStore(Image, 0, uvec4(1));");
    ASSERT_EQ(written.bindings.size(), 2u);
    EXPECT_EQ(written.bindings[1].kind, gpu::Binding::Kind::Table);
    EXPECT_TRUE(!written.bindings[1].reads && written.bindings[1].writes);
    EXPECT_THROW(reflect(layout + "readonly uimage1D", load), Error);
    EXPECT_THROW(reflect("layout(set = 0, binding = 1) uniform utextureBuffer", "value = texelFetch(Image, 0).x;"),
                 Error);
}

TEST_F(ShaderFolder, TooManyStorageBuffersAreAnError)
{
    gpu::Device device = openDevice({.shaderDirectory = folder_.string()});
    for (const char* part : {"lib", "shared"})
        fs::copy(fs::path(TRICHROME_SOURCE_DIR) / "shaders" / part, folder_ / part);
    const auto create = [&](int buffers) -> std::string {
        std::string declarations, sum;
        for (int i = 0; i < buffers; ++i) {
            declarations += fmt::format("layout(set = 0, binding = {0}) buffer B{0} {{ uint value{0}; }};\n", i);
            sum += fmt::format("value{} + ", i);
        }
        write("many.comp", "#version 460\n#extension GL_GOOGLE_include_directive : require\n"
                           "#include \"lib/lanes.glsl\"\nlayout(local_size_x = 1) in;\nTABLE(1, 0, Elements);\n" +
                               declarations + "void main() { value0 = " + sum + "FETCH(Elements, 0).x; }\n");
        try {
            device.createComputePipeline({.label = "many"});
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(create(10), "");
    EXPECT_NE(create(11).find("\"many\" declares 11 storage buffers, more than the limit of 10"), std::string::npos);
}

TEST_F(ShaderFolder, HotReloadRunsTheEditedShader)
{
    write("path/number.glsl", "const uint NUMBER = 1;\n");
    write("reload.comp", kernel("NUMBER + 10"));
    gpu::Device device = openDevice({.shaderDirectory = folder_.string()});
    gpu::ShaderWatcher watcher(folder_);
    const gpu::Buffer values = device.createBuffer({.label = "values", .size = 16});
    const auto result = [&] {
        const gpu::ComputePipeline pipeline = device.createComputePipeline({.label = "reload"});
        const gpu::BindGroup group =
            device.createBindGroup({.label = "values", .pipeline = &pipeline, .buffers = {{"Values", &values}}});
        gpu::CommandEncoder encoder = device.createCommandEncoder("reload");
        encoder.dispatch({.pipeline = &pipeline, .groups = {&group}});
        device.queue().submit(std::move(encoder));
        return device.queue().readAs<uint32_t>(values)[0];
    };
    EXPECT_EQ(result(), 11u);
    EXPECT_FALSE(watcher.changed());

    write("path/number.glsl", "const uint NUMBER = 22;\n");
    EXPECT_TRUE(watcher.changed());
    EXPECT_EQ(result(), 32u);
    write("reload.comp", "#version 460\nnonsense");
    EXPECT_TRUE(watcher.changed());
    EXPECT_THROW(result(), Error);
    write("reload.comp", kernel("NUMBER"));
    EXPECT_EQ(result(), 22u) << "an error in between does no harm";
    EXPECT_TRUE(device.takeValidationMessages().empty());
}

} // namespace
