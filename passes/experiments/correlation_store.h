#pragma once
// Finished batches on disk and between processes, so that nothing is measured twice. One file a batch, whole or absent.

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "passes/experiments/correlation.h"

namespace passes
{

// CBOR (RFC 8949); every number comes back exactly. Throws Error: not such bytes.
std::vector<std::byte> toBytes(const CorrelationBatch& batch);
CorrelationBatch fromBytes(std::span<const std::byte> bytes);

// DIR/batches: settings.json and the batches that were measured with them.
class CorrelationStore
{
  public:
    explicit CorrelationStore(const std::filesystem::path& directory) : path_(directory / "batches") {}

    // Makes the directory ready for what `facts` decide. Throws Error: it holds batches and `resume` is off, or they
    // were measured with other facts, of which the first is named.
    void open(const std::vector<std::pair<std::string, std::string>>& facts, bool resume) const;

    void save(const CorrelationBatch& batch) const;
    // Those that belong to a measurement of batches of `runs` [index], in no particular order.
    std::vector<CorrelationBatch> load(std::span<const uint32_t> runs) const;

  private:
    std::filesystem::path path_;
};

} // namespace passes
