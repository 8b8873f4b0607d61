#pragma once
// Numbers and points for tests, the same on every run.

#include <cstdint>
#include <random>

#include <glm/glm.hpp>

class Random
{
  public:
    explicit Random(uint32_t seed) : engine_(seed) {}
    float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine_); }
    glm::vec3 point(float size) { return {between(-size, size), between(-size, size), between(-size, size)}; }

  private:
    std::mt19937 engine_;
};
