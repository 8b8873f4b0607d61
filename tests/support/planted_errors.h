#pragma once
// Errors that somebody could make in the stages that resample. Each is planted where a test claims that it would be
// found: in the toy world (tests/shaders/toy), in pictures (tests/images), and under the hunter (tests/hunt).

#include <string>
#include <vector>

namespace support
{

struct PlantedError {
    const char* name;
    const char* file; // below shaders/
    const char* right;
    const char* wrong;
};
const std::vector<PlantedError>& plantedErrors();
const PlantedError& plantedError(const std::string& name); // throws Error naming those that there are

} // namespace support
