#pragma once
// Embree's ways to trace a set of rays, each as fast as it goes: one ray at a time, packets of 4, 8 and 16, streams.

#include <functional>
#include <string>
#include <vector>

#include "tests/support/ray_sets.h"

// One way, made ready for one set of rays.
struct EmbreeApi {
    std::string name;
    std::function<void()> prepare; // puts the rays back as they were: not timed
    std::function<void()> run;     // on `threads` threads
    std::function<size_t()> hits;  // of the latest run
};

std::vector<EmbreeApi> embreeApis(const EmbreeScene& scene, const std::vector<TestRay>& rays, bool anyHit,
                                  unsigned threads);
