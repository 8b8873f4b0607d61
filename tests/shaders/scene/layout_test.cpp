// Structs in shaders/shared have the same layout in both languages: both read the same bytes, member by member.

#include "tests/shaders/scene/layout_test.h"

#include <array>
#include <bit>
#include <numeric>

#include "shaders/shared/frame.h"
#include "shaders/shared/scene.h"
#include "tests/support/gpu_fixture.h"

namespace
{

// Two of T whose words are 0x3f800000 (1.0) and following.
template <class T>
struct Counting {
    std::array<uint32_t, 2 * sizeof(T) / 4> words;
    std::array<T, 2> elements;

    Counting()
    {
        std::iota(words.begin(), words.end(), 0x3f800000u);
        elements = std::bit_cast<std::array<T, 2>>(words);
    }
    std::vector<uint32_t> list() const { return {words.begin(), words.end()}; }
};

TEST_F(GpuTest, SharedStructsHaveOneLayout)
{
    const Counting<shared::FrameUniform> frames;
    const Counting<shared::SceneUniform> scenes;
    const auto bits = [](auto value) { return std::bit_cast<uint32_t>(value); };
    std::vector<uint32_t> expected;
    for (size_t element = 0; element < 2; ++element) {
#define READ_FRAME(MEMBER) expected.push_back(bits(frames.elements[element].MEMBER));
#define READ_SCENE(MEMBER) expected.push_back(bits(scenes.elements[element].MEMBER));
        FRAME_MEMBERS(READ_FRAME)
        SCENE_MEMBERS(READ_SCENE)
    }
    const gpu::Buffer frameBuffer = upload("frames", frames.list(), gpu::Usage::Uniform),
                      sceneBuffer = upload("scenes", scenes.list(), gpu::Usage::Uniform),
                      words = create<uint32_t>("words", expected.size());
    run({.shader = TEST_SPIRV_DIR "/layout_test",
         .buffers = {{"Frames", &frameBuffer}, {"Scenes", &sceneBuffer}, {"Words", &words}},
         .threads = {2}});
    EXPECT_EQ(download<uint32_t>(words), expected);
}

} // namespace
