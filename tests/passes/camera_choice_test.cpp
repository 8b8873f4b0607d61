#include "passes/camera_choice.h"

#include "engine/base/error.h"

#include <gtest/gtest.h>

namespace
{

scene::Scene threeCameras()
{
    scene::Scene scene;
    scene.name = "room";
    for (const char* name : {"door", "2", "door"}) scene.cameras.push_back({.name = name});
    return scene;
}

} // namespace

TEST(ChooseCamera, TakesNamesBeforeIndicesAndTheFirstByDefault)
{
    EXPECT_EQ(passes::chooseCamera(threeCameras(), ""), 0u);
    EXPECT_EQ(passes::chooseCamera(threeCameras(), "door"), 0u);
    EXPECT_EQ(passes::chooseCamera(threeCameras(), "1"), 1u);
    EXPECT_EQ(passes::chooseCamera(threeCameras(), "2"), 1u); // a name
}

TEST(ChooseCamera, ListsTheCamerasWhenThereIsNoSuch)
{
    for (const char* wrong : {"3", "window", "-1", "1.0", "0x1", " 1", "4294967296"}) {
        try {
            passes::chooseCamera(threeCameras(), wrong);
            FAIL() << wrong;
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()), "Scene \"room\" has no camera \"" + std::string(wrong) +
                                                     "\"; it has: 0 \"door\", 1 \"2\", 2 \"door\".");
        }
    }
}
