#include "ui/cli/frame_chains.h"

#include <map>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace
{

using ui::FrameChains;

// Negative numbers, of frames that are only rendered for the next ones, in parentheses: -(number + 100).
std::vector<int64_t> numbersOf(const FrameChains& chains)
{
    std::vector<int64_t> numbers;
    for (uint64_t place = 0; place < chains.places(); ++place) {
        const FrameChains::Frame frame = chains.at(place);
        numbers.push_back(frame.wanted ? frame.number : -(frame.number + 100));
    }
    return numbers;
}

TEST(FrameChains, EachBeginWithItsOwnWarmUp)
{
    const FrameChains chains{.first = 4, .end = 9, .length = 2, .warmUp = 1};
    EXPECT_EQ(numbersOf(chains), (std::vector<int64_t>{-103, 4, 5, -105, 6, 7, -107, 8}));
    for (uint64_t place = 0; place < chains.places(); ++place)
        EXPECT_EQ(chains.at(place).begins, place % 3 == 0) << place;
    EXPECT_EQ(numbersOf({.first = 1, .end = 3, .length = 2, .warmUp = 3}),
              (std::vector<int64_t>{-98, -99, -100, 1, 2}));
    EXPECT_EQ(numbersOf({.first = 0, .end = 3, .length = 1}), (std::vector<int64_t>{0, 1, 2}));
}

// What a process renders does not depend on how many there are: only who does.
TEST(FrameChains, AreEachRenderedByOneProcess)
{
    for (const FrameChains& chains : {FrameChains{.first = 4, .end = 15, .length = 2, .warmUp = 1},
                                      {.first = 0, .end = 7, .length = 1},
                                      {.first = 0, .end = 7, .length = 7}})
        for (const uint32_t count : {1u, 2u, 3u, 20u}) {
            std::multiset<uint64_t> places;
            uint32_t idle = 0;
            for (uint32_t index = 0; index < count; ++index) {
                const size_t before = places.size();
                bool begun = false;
                uint64_t next = 0; // where the last frame's history would fit
                for (uint64_t place = chains.turn(0, index, count); place < chains.places();
                     place = chains.turn(place + 1, index, count)) {
                    begun = begun || chains.at(place).begins;
                    EXPECT_TRUE(chains.at(place).begins || (begun && place == next)) << place;
                    places.insert(place);
                    next = place + 1;
                }
                idle += places.size() == before;
            }
            ASSERT_EQ(places.size(), chains.places()) << count;
            for (uint64_t place = 0; place < chains.places(); ++place) EXPECT_EQ(places.count(place), 1u) << place;
            const int64_t chunks = (chains.end - chains.first - 1) / chains.length + 1;
            EXPECT_EQ(idle, count > chunks ? count - chunks : 0) << "shared out evenly";
        }
}

} // namespace
