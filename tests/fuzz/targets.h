#pragma once
// What reads untrusted bytes, each as one function: it may throw Error and nothing else, must keep what its header
// promises, and must not touch memory that is not its own. Fuzzed by fuzzer.cpp, replayed by corpus_test.cpp.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace fuzz
{

using Bytes = std::span<const std::byte>;

struct Target {
    const char* name;
    bool (*run)(Bytes bytes); // whether they were accepted; an Error is a refusal
};
std::span<const Target> targets();

// Small valid inputs of a target, made by our own writers where there is one: where fuzzing starts.
std::vector<std::vector<std::byte>> seeds(const std::string& target);

} // namespace fuzz
