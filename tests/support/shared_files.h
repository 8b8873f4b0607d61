#pragma once
// Files beside the repository (../shared) that some tests read. They are no part of it: without them those tests are
// skipped, loudly.

#include <filesystem>
#include <string>
#include <vector>

// TRICHROME_SHARED, else ../shared beside the source. Empty when it has no such entry.
std::filesystem::path sharedPath(const std::string& entry);

#define SKIP_WITHOUT_SHARED(entry)                                                                                     \
    if (sharedPath(entry).empty()) GTEST_SKIP() << "SKIPPED, NOT TESTED: there is no ../shared/" << (entry)

// Broken and extreme files, from the manifest beside them.
struct MalformedFile {
    std::filesystem::path path;
    std::string kind; // gltf, glb, image, hdr
    bool mayFail = false;
    bool mayLoad = false;
    std::string why;
};
std::vector<MalformedFile> malformedFiles();

// All .gltf and .glb files below a folder there, sorted.
std::vector<std::filesystem::path> sharedModels(const std::string& folder);
