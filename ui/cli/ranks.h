#pragma once
// Processes that share one piece of work. `trichrome` is alone; `trichrome-mpi`, built where MPI is found, is one of
// those that mpirun started. An executable links one of the two definitions: ui/ranks_alone.cpp, ui/ranks_mpi.cpp.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ui
{

using Bytes = std::vector<std::byte>;

// Alone, where nobody says otherwise.
class Ranks
{
  public:
    virtual ~Ranks() = default;
    virtual uint32_t index() const { return 0; } // of this process; 0 keeps the books
    virtual uint32_t count() const { return 1; }
    virtual void barrier() const {}                                                                // until all are here
    virtual std::vector<Bytes> gather(const std::vector<Bytes>& records) const { return records; } // at 0: all, by rank
    virtual int finish(int exitCode) const { return exitCode; } // the process's last words; a failure ends all of them
};

const Ranks& ranks();

} // namespace ui
