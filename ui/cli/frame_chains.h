#pragma once
// The frames of a render as chains: within one each frame may reuse those before it, and chains know nothing of each
// other, so that processes can share them.

#include <cstdint>

namespace ui
{

struct FrameChains {
    int64_t first = 0, end = 1; // numbers of the frames that are asked for
    int64_t length = 1;         // of a chain, in such frames; the last one may be shorter
    uint32_t warmUp = 0;        // frames that each chain renders before those, only for their history

    // Rendered alone, chains follow each other. So each frame, those of warm-ups too, has a place from 0 on.
    struct Frame {
        int64_t number = 0;  // says what it shows, and which random numbers it has; may be negative in a warm-up
        bool begins = false; // a chain
        bool wanted = true;  // not of a warm-up
    };
    uint64_t places() const;
    Frame at(uint64_t place) const;

    // Chains are dealt out to processes in turns: the first place from `place` on whose chain is that of process
    // `index` of `count`. It may be beyond the last.
    uint64_t turn(uint64_t place, uint32_t index, uint32_t count) const;

  private:
    uint64_t size() const { return uint64_t(length) + warmUp; } // of a chain, in places
};

} // namespace ui
