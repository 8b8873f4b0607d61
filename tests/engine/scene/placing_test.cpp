#include "engine/scene/placing.h"

#include <limits>

#include <gtest/gtest.h>

namespace scene
{

TEST(Placing, NothingStandsWhereACoordinateIsNotFiniteOrTooLarge)
{
    constexpr double INF = std::numeric_limits<double>::infinity(), NAN64 = std::numeric_limits<double>::quiet_NaN();
    for (int axis = 0; axis < 3; ++axis) {
        for (const double bad : {NAN64, INF, -INF, 1e12, -1e12}) {
            glm::dmat4 worldFromNode(1);
            worldFromNode[3][axis] = bad;
            Camera camera;
            PunctualLight light;
            EXPECT_FALSE(placeCamera(camera, worldFromNode)) << axis << ' ' << bad;
            EXPECT_FALSE(placeLight(light, worldFromNode)) << axis << ' ' << bad;
            worldFromNode[3][axis] = -0.99e12;
            EXPECT_TRUE(placeCamera(camera, worldFromNode));
            EXPECT_EQ(placeLight(light, worldFromNode), glm::dvec3(worldFromNode[3]));
        }
    }
}

} // namespace scene
