#include "tests/support/planted_shaders.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "engine/base/error.h"

namespace support
{

PlantedShaders::PlantedShaders(const std::string& name)
    : folder_(std::filesystem::path(testing::TempDir()) / ("planted_" + name))
{
    std::filesystem::remove_all(folder_);
    std::filesystem::copy(TRICHROME_SOURCE_DIR "/shaders", folder_, std::filesystem::copy_options::recursive);
}

PlantedShaders::~PlantedShaders()
{
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

void PlantedShaders::plant(const PlantedError& error)
{
    std::ostringstream stream;
    stream << std::ifstream(folder_ / error.file).rdbuf();
    std::string text = stream.str();
    const std::string right = error.right;
    const size_t at = text.find(right);
    if (at == std::string::npos) throw Error("The text to replace is gone from {}: {}", error.file, right);
    text.replace(at, right.size(), error.wrong);
    std::ofstream(folder_ / error.file) << text;
}

} // namespace support
