#pragma once
// Errors planted in the shaders' text, to be compiled at run time: would a test notice?

#include <filesystem>
#include <string>

#include "tests/support/planted_errors.h"

namespace support
{

// A copy of shaders/ in a temporary folder of this name, there until the object goes.
class PlantedShaders
{
  public:
    explicit PlantedShaders(const std::string& name);
    ~PlantedShaders();
    PlantedShaders(const PlantedShaders&) = delete;
    PlantedShaders& operator=(const PlantedShaders&) = delete;

    // Replaces the error's first `right` in its file. Throws Error: that text is not there.
    void plant(const PlantedError& error);
    const std::filesystem::path& folder() const { return folder_; }

  private:
    std::filesystem::path folder_;
};

} // namespace support
