#pragma once
// Finished repeats of `converge` on disk, one file each: what --resume goes on from.

#include <filesystem>
#include <string>
#include <vector>

#include "passes/experiments/race.h"

namespace passes
{

class RaceStore
{
  public:
    // `key` stands for everything that decides the figures; `names` of the methods name the pictures.
    RaceStore(std::filesystem::path directory, std::string key, std::vector<std::string> names);

    void requireNew() const; // Throws Error: there are repeats, which may have taken hours
    // Whole or not at all; the pictures of the first repeat beside it. Throws Error.
    void write(size_t index, const Repeat& repeat) const;
    // Those that are there, without gaps, at most `limit`. Throws Error: of another key, or damaged.
    std::vector<Repeat> read(size_t limit) const;

    std::filesystem::path picture(size_t method) const;

  private:
    std::filesystem::path file(size_t index) const;

    std::filesystem::path directory_;
    std::string key_;
    std::vector<std::string> names_;
};

} // namespace passes
