#include "tests/support/planted_shaders.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

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

void PlantedShaders::plant(const std::string& file, const std::string& right, const std::string& wrong)
{
    std::ostringstream stream;
    stream << std::ifstream(folder_ / file).rdbuf();
    std::string text = stream.str();
    const size_t at = text.find(right);
    ASSERT_NE(at, std::string::npos) << "the text to replace is gone from " << file << ": " << right;
    text.replace(at, right.size(), wrong);
    std::ofstream(folder_ / file) << text;
}

} // namespace support
