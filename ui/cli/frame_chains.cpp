#include "ui/cli/frame_chains.h"

namespace ui
{

uint64_t FrameChains::places() const
{
    const auto frames = uint64_t(end - first);
    const uint64_t chains = (frames - 1) / uint64_t(length) + 1;
    return frames + chains * warmUp;
}

FrameChains::Frame FrameChains::at(uint64_t place) const
{
    const uint64_t within = place % size();
    return {.number = first + int64_t(place / size()) * length + int64_t(within) - int64_t(warmUp),
            .begins = within == 0,
            .wanted = within >= warmUp};
}

uint64_t FrameChains::turn(uint64_t place, uint32_t index, uint32_t count) const
{
    const uint64_t chain = place / size(), ahead = (index + count - chain % count) % count;
    return ahead == 0 ? place : (chain + ahead) * size();
}

} // namespace ui
