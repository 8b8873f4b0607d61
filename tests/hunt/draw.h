#pragma once
// Random choices, the same on every machine: the standard library's distributions are not.

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>
#include <random>

#include <glm/glm.hpp>

namespace hunt
{

class Draw
{
  public:
    explicit Draw(std::initializer_list<uint64_t> address) // of this stream of numbers
    {
        uint64_t state = 0;
        for (const uint64_t part : address) state = mix(state ^ mix(part));
        random_.seed(state);
    }

    uint64_t word() { return random_(); }
    double uniform() { return double(word() >> 11) * 0x1p-53; } // [0, 1)
    double between(double low, double high) { return low + (high - low) * uniform(); }
    double logBetween(double low, double high) { return low * std::pow(high / low, uniform()); }
    uint32_t below(uint32_t count) { return uint32_t(uniform() * count); }
    uint32_t from(uint32_t low, uint32_t high) { return low + below(high - low + 1); } // both included
    bool chance(double probability) { return uniform() < probability; }
    template <class T>
    T of(std::initializer_list<T> choices)
    {
        return choices.begin()[below(uint32_t(choices.size()))];
    }

    glm::vec3 color(double low = 0.1, double high = 0.95)
    {
        const double r = between(low, high), g = between(low, high), b = between(low, high);
        return {r, g, b};
    }
    glm::vec3 point(double low, double high) { return color(low, high); }
    glm::vec3 direction()
    {
        const double y = between(-1, 1), phi = between(0, 2 * std::numbers::pi), r = std::sqrt(1 - y * y);
        return {r * std::cos(phi), y, r * std::sin(phi)};
    }

    // SplitMix64's finalizer.
    static uint64_t mix(uint64_t z)
    {
        z += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }

  private:
    std::mt19937_64 random_;
};

} // namespace hunt
