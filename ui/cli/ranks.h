#pragma once
// Processes that share one piece of work. `trichrome` is alone; `trichrome-mpi`, built where MPI is found, is one of
// those that mpirun started. An executable links one of the two definitions: ui/ranks_alone.cpp, ui/ranks_mpi.cpp.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace ui
{

using Bytes = std::vector<std::byte>;

// How a process ends; with a sentence for a person where something is wrong.
struct Ending {
    int exitCode = 0;
    std::string sentence;
};

// Alone, where nobody says otherwise.
class Ranks
{
  public:
    virtual ~Ranks() = default;
    virtual uint32_t index() const { return 0; } // of this process; 0 keeps the books
    virtual uint32_t count() const { return 1; }
    // Once, when nothing stands in the way of the work: waits until all are here. Not 0 where one is not, and has said
    // why: the exit code to end with.
    virtual int meet() const { return 0; }
    virtual std::vector<Bytes> gather(const std::vector<Bytes>& records) const { return records; } // at 0: all, by rank
    virtual void sum(std::vector<double>&) const {} // each number over all processes, at each of them

    // The process's last words. Of those that fail before they have met, only the first has any; a failure after that
    // ends all of them.
    virtual int finish(const Ending& ending) const
    {
        if (!ending.sentence.empty()) std::fprintf(stderr, "trichrome: %s\n", ending.sentence.c_str());
        return ending.exitCode;
    }
};

const Ranks& ranks();

} // namespace ui
