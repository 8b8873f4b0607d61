#pragma once
// Processes that share one piece of work. `trichrome` is alone; `trichrome-mpi`, built where MPI is found, is one of
// those that mpirun started. An executable links one of the two definitions: ui/ranks_alone.cpp, ui/ranks_mpi.cpp.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ui
{

using Bytes = std::vector<std::byte>;

class Ranks
{
  public:
    virtual ~Ranks() = default;
    virtual uint32_t index() const = 0; // of this process; 0 keeps the books
    virtual uint32_t count() const = 0;
    virtual void barrier() const = 0;                                               // until all are here
    virtual std::vector<Bytes> gather(const std::vector<Bytes>& records) const = 0; // at 0: all, by rank; else nothing
    virtual int finish(int exitCode) const = 0; // the process's last words; a failure ends all of them
};

const Ranks& ranks();

} // namespace ui
