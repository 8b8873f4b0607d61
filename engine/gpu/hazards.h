#pragma once
// Decides when a barrier must stand between two pieces of work of one command buffer.

#include <algorithm>
#include <span>
#include <vector>

namespace gpu
{

// How one piece of work touches one buffer. `Id` is whatever names a buffer: its Vulkan handle, or a number in tests.
template <class Id>
struct BufferUse {
    Id buffer{};
    bool reads = false;
    bool writes = false;
};

// Remembers what was touched since the last barrier. One barrier covers all buffers, so memory is dropped at each.
template <class Id>
class HazardTracker
{
  public:
    // Whether a barrier must come before this work: it touches what was written, or writes what was read.
    bool needsBarrier(std::span<const BufferUse<Id>> uses)
    {
        const bool hazard = std::ranges::any_of(uses, [&](const BufferUse<Id>& use) {
            const bool touches = use.reads || use.writes;
            return (touches && contains(written_, use.buffer)) || (use.writes && contains(read_, use.buffer));
        });
        if (hazard) {
            written_.clear();
            read_.clear();
        }
        for (const BufferUse<Id>& use : uses) {
            if (use.writes) insert(written_, use.buffer);
            if (use.reads) insert(read_, use.buffer);
        }
        return hazard;
    }

  private:
    static bool contains(const std::vector<Id>& set, Id buffer) { return std::ranges::find(set, buffer) != set.end(); }
    static void insert(std::vector<Id>& set, Id buffer)
    {
        if (!contains(set, buffer)) set.push_back(buffer);
    }

    std::vector<Id> written_; // a few dozen buffers at most: a search is as fast as hashing
    std::vector<Id> read_;
};

} // namespace gpu
