// Animations that break a rule: the scene is there at rest, and one sentence says why they cannot be played.

#include <limits>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/scene/motion.h"
#include "tests/support/tiny_gltf.h"

namespace scene
{
namespace
{

using nlohmann::json;

const json TRANSLATION = {{"node", 0}, {"path", "translation"}};
const json ROTATION = {{"node", 0}, {"path", "rotation"}};
const json WEIGHTS = {{"node", 0}, {"path", "weights"}};
constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();
constexpr float INFINITE = std::numeric_limits<float>::infinity();

// It loads, warns, and cannot be chosen.
void expectFault(const TinyGltf& file, const std::string& sentence)
{
    EXPECT_EQ(file.error(), "");
    const Scene scene = file.load();
    ASSERT_TRUE(scene.motion);
    ASSERT_EQ(scene.motion->animations.size(), 1u);
    EXPECT_EQ(scene.motion->animations[0].fault, sentence);
    EXPECT_TRUE(scene.motion->animations[0].channels.empty());
    EXPECT_TRUE(file.warns("An animation cannot be played: " + sentence));
    try {
        chooseAnimations(scene, "all");
        ADD_FAILURE() << "chosen";
    } catch (const Error& error) {
        EXPECT_EQ(error.what(), "Animation 0 \"\" cannot be played: " + sentence);
    }
    EXPECT_TRUE(chooseAnimations(scene, "off").empty());
}

} // namespace

TEST(GltfAnimations, TimesMustBeFiniteAndIncrease)
{
    {
        TinyGltf file;
        file.animate(TRANSLATION, {0, 1, 0.5f}, {0, 0, 0, 1, 1, 1, 2, 2, 2}, "VEC3");
        expectFault(file,
                    "animations[0].samplers[0].input has the time 0.5 s at key 2 after 1 s, but times must increase: "
                    "remove one of the keys.");
    }
    {
        TinyGltf file;
        file.animate(TRANSLATION, {0, 1, 1}, {0, 0, 0, 1, 1, 1, 2, 2, 2}, "VEC3");
        expectFault(file,
                    "animations[0].samplers[0].input has the time 1 s at key 2 after 1 s, but times must increase: "
                    "remove one of the keys.");
    }
    for (const float bad : {NOT_A_NUMBER, INFINITE}) {
        TinyGltf file;
        file.animate(TRANSLATION, {0, bad}, {0, 0, 0, 1, 1, 1}, "VEC3");
        expectFault(file,
                    fmt::format("animations[0].samplers[0].input has {} at element 1, which is not finite.", bad));
    }
}

TEST(GltfAnimations, ValuesMustBeFiniteAndRotationsNotZero)
{
    TinyGltf file;
    file.animate(TRANSLATION, {0, 1}, {0, 0, 0, 1, NOT_A_NUMBER, 1}, "VEC3");
    expectFault(file, "animations[0].samplers[0].output has nan at element 1, which is not finite.");

    TinyGltf rotation;
    rotation.animate(ROTATION, {0, 1}, {0, 0, 0, 1, 0, 0, 0, 0}, "VEC4");
    expectFault(rotation,
                "animations[0].samplers[0].output has a rotation of length 0 at key 1: a rotation is a quaternion "
                "of length 1.");

    TinyGltf spline; // whose tangents may well be zero
    std::vector<float> keys(24, 0.0f);
    keys[7] = 1;
    spline.animate(ROTATION, {0, 1}, keys, "VEC4", "CUBICSPLINE");
    expectFault(spline,
                "animations[0].samplers[0].output has a rotation of length 0 at key 1: a rotation is a quaternion "
                "of length 1.");
    keys[19] = 1;
    TinyGltf good;
    good.animate(ROTATION, {0, 1}, keys, "VEC4", "CUBICSPLINE");
    EXPECT_EQ(good.load().motion->animations[0].fault, "");
}

TEST(GltfAnimations, CountsMustFit)
{
    TinyGltf file;
    file.animate(TRANSLATION, {0, 1}, {0, 0, 0, 1, 1, 1, 2, 2, 2}, "VEC3");
    expectFault(file, "animations[0].samplers[0] has 3 outputs for 2 keys, but needs 1 for each.");

    TinyGltf fewer; // as ever, this refuses the file
    fewer.animate(TRANSLATION, {0, 1}, {0, 0, 0}, "VEC3");
    EXPECT_EQ(fewer.error(), "animations[0].samplers[0] has 1 outputs for 2 keys, fewer than 1 for each.");

    TinyGltf weights;
    const json target = {{"POSITION", weights.accessor<float>(std::vector<float>(9, 1.0f), "VEC3")}};
    weights.primitive()["targets"] = {target, target};
    weights.animate(WEIGHTS, {0, 1}, {0, 1, 2}, "SCALAR");
    expectFault(weights, "animations[0].samplers[0] has 3 outputs for 2 keys, but needs 2 for each.");

    TinyGltf none;
    none.animate(WEIGHTS, {0, 1}, {0, 1}, "SCALAR");
    expectFault(none, "animations[0].samplers[0] moves the weights of nodes[0], whose meshes[0] has no morph targets.");
}

TEST(GltfAnimations, TypesMustFit)
{
    TinyGltf file;
    file.animate(TRANSLATION, {0, 1}, {0, 0, 0, 1, 1, 1, 2, 2}, "VEC4");
    expectFault(file,
                "animations[0].samplers[0].output refers to an accessor of VEC4 5126, but translation needs VEC3 of "
                "floats.");
    TinyGltf integers;
    integers.animate(ROTATION, {0, 1}, {0, 0, 0, 1, 0, 0, 0, 1}, "VEC4");
    integers.json["animations"][0]["samplers"][0]["output"] =
        integers.accessor<int16_t>({0, 0, 0, 32767, 0, 32767, 0, 0}, "VEC4");
    expectFault(integers,
                "animations[0].samplers[0].output refers to an accessor of VEC4 5122, but rotation needs VEC4 of "
                "floats or normalized integers.");
    integers.json["accessors"].back()["normalized"] = true;
    EXPECT_EQ(integers.load().motion->animations[0].fault, "");

    TinyGltf times;
    times.animate(TRANSLATION, {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3");
    times.json["animations"][0]["samplers"][0]["input"] = times.accessor<uint16_t>({0, 1}, "SCALAR");
    expectFault(times,
                "animations[0].samplers[0].input refers to an accessor of SCALAR 5123, but a time needs SCALAR of "
                "floats.");
    TinyGltf nothing; // a count without bytes: any number of keys for free
    nothing.animate(TRANSLATION, {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3");
    nothing.json["accessors"].push_back({{"componentType", 5126}, {"count", 2000000000}, {"type", "VEC3"}});
    nothing.json["animations"][0]["samplers"][0]["output"] = nothing.json["accessors"].size() - 1;
    expectFault(nothing, "animations[0].samplers[0].output refers to an accessor without a buffer view.");

    TinyGltf word;
    word.animate(TRANSLATION, {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3", "SPLINE");
    expectFault(word, "animations[0].samplers[0].interpolation is \"SPLINE\", not STEP, LINEAR or CUBICSPLINE.");
}

TEST(GltfAnimations, TargetsMustBeThereAndMovable)
{
    TinyGltf missing;
    missing.animate({{"node", 7}, {"path", "translation"}}, {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3");
    EXPECT_EQ(missing.error(), "animations[0].channels[0].target.node is 7, but the file has 1 nodes.");

    TinyGltf twice;
    twice.animate(TRANSLATION, {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3");
    twice.animate(TRANSLATION, {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3");
    expectFault(twice, "animations[0].channels[1] moves the translation of the same object as another channel of this "
                       "animation.");

    TinyGltf matrix;
    matrix.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1};
    matrix.animate(TRANSLATION, {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3");
    expectFault(matrix,
                "animations[0].channels[0] moves nodes[0], which has a matrix: only translation, rotation and scale "
                "can be animated.");

    TinyGltf meshless;
    meshless.json["nodes"].push_back(json::object());
    meshless.animate({{"node", 1}, {"path", "weights"}}, {0, 1}, {0, 1}, "SCALAR");
    expectFault(meshless, "animations[0].channels[0] moves the weights of nodes[1], which has no mesh.");
}

TEST(GltfAnimations, WhatIsNotFollowedIsLeftOutAlone)
{
    TinyGltf file;
    file.animate({{"node", 0}, {"path", "teleport"}}, {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3");
    file.animate({{"path", "translation"}}, {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3");
    file.animatePointer("/materials/0/normalTexture/scale", {0, 1}, {0, 1}, "SCALAR");
    file.animate(TRANSLATION, {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3");
    EXPECT_TRUE(file.warns("Left out an animation of the unknown path \"teleport\"."));
    EXPECT_TRUE(file.warns("Left out an animation without a node."));
    EXPECT_TRUE(file.warns("Left out an animation of \"/materials/0/normalTexture/scale\", which is not followed."));
    const Scene scene = file.load();
    EXPECT_EQ(scene.motion->animations[0].fault, "");
    EXPECT_EQ(scene.motion->animations[0].channels.size(), 1u);
}

TEST(GltfAnimations, PointersMustPointIntoTheFile)
{
    TinyGltf file;
    file.animatePointer("/nodes/1/translation", {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3");
    expectFault(file,
                "animations[0].channels[0].target points to \"/nodes/1/translation\", but the file has 1 of these.");
    TinyGltf lacks;
    lacks.animate({{"path", "pointer"}}, {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3");
    expectFault(lacks, "animations[0].channels[0].target lacks the \"pointer\" of KHR_animation_pointer.");
    TinyGltf degrees;
    degrees.animatePointer("/nodes/0/extensions/KHR_node_visibility/visible", {0, 1}, {0, 1}, "SCALAR");
    expectFault(degrees, "animations[0].samplers[0] makes a node visible by degrees: its interpolation must be STEP.");
    for (const char* pointer : {"/nodes/0x/translation", "/nodes//translation", "/nodes/-1/translation",
                                "/nodes/99999999999/translation", "/nodes/0/translation/", "", "/nodes/translation"}) {
        TinyGltf odd;
        odd.animatePointer(pointer, {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3");
        EXPECT_TRUE(odd.warns(fmt::format("Left out an animation of \"{}\", which is not followed.", pointer)));
    }
}

// One that is broken takes none of the others with it.
TEST(GltfAnimations, OthersCanBePlayed)
{
    TinyGltf file;
    file.animate(TRANSLATION, {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3");
    json broken = file.json["animations"][0];
    broken["name"] = "broken";
    broken["samplers"][0]["input"] = file.accessor<float>({1, 0}, "SCALAR");
    file.json["animations"][0]["name"] = "good";
    file.json["animations"].push_back(broken);
    const Scene scene = file.load();
    EXPECT_EQ(chooseAnimations(scene, "good"), std::vector<uint32_t>{0});
    EXPECT_EQ(chooseAnimations(scene, "0"), std::vector<uint32_t>{0});
    EXPECT_THROW(chooseAnimations(scene, "broken"), Error);
    EXPECT_THROW(chooseAnimations(scene, "1"), Error);
    EXPECT_THROW(chooseAnimations(scene, "all"), Error);
    try {
        chooseAnimations(scene, "Walk");
        ADD_FAILURE() << "chosen";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "The scene has no animation \"Walk\": it has 0 \"good\", 1 \"broken\".");
    }
}

// Shared accessors are kept once: 10^4 channels over 10^5 keys are 10^5 numbers, not 10^9.
TEST(GltfAnimations, TenThousandChannelsShareAHundredThousandKeys)
{
    TinyGltf file;
    std::vector<float> times, values;
    for (int i = 0; i < 100000; ++i) {
        times.push_back(float(i) / 100);
        values.insert(values.end(), {float(i % 10), 0, 0});
    }
    file.animate(TRANSLATION, times, values, "VEC3");
    json& animation = file.json["animations"][0];
    for (size_t i = 1; i < 10000; ++i) {
        file.json["nodes"].push_back({{"mesh", 0}});
        file.json["scenes"][0]["nodes"].push_back(i);
        animation["channels"].push_back({{"sampler", 0}, {"target", {{"node", i}, {"path", "translation"}}}});
    }
    const Scene scene = file.load();
    ASSERT_EQ(scene.motion->animations[0].channels.size(), 10000u);
    EXPECT_EQ(scene.motion->numbers.size(), 2u);
    EXPECT_EQ(scene.motion->meshes.size(), 1u);
    EXPECT_LT(scene.motion->bytes(), uint64_t{16} << 20);
}

} // namespace scene
