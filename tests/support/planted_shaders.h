#pragma once
// Errors planted in the shaders' text, to be compiled at run time: would a test notice?

#include <filesystem>
#include <string>

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

    // Replaces the first `right` in a file (its path below shaders/). A text that is not there fails the test.
    void plant(const std::string& file, const std::string& right, const std::string& wrong);
    const std::filesystem::path& folder() const { return folder_; }

  private:
    std::filesystem::path folder_;
};

} // namespace support
