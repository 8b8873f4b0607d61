#pragma once
// Sentences for the person who loads a scene; repeated ones are counted, not repeated.

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace scene
{

class Warnings
{
  public:
    // A sentence that ends with a period. `count` times the same sentence become one.
    void add(const std::string& sentence, size_t count = 1);

    // In order of first appearance: "Clamped the roughness of a material (12 times)."
    std::vector<std::string> sentences() const;

  private:
    std::vector<std::pair<std::string, size_t>> entries_;
    size_t leftOut_ = 0;
};

} // namespace scene
