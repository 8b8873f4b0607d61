#pragma once
// Finished batches on disk and between processes, so that nothing is measured twice. One file a batch, whole or absent.

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ui/cli/ranks.h"
#include "ui/report/correlation.h"

namespace ui
{

// CBOR (RFC 8949); every number comes back exactly. Throws Error: not such bytes.
Bytes toBytes(const CorrelationBatch& batch);
CorrelationBatch fromBytes(const Bytes& bytes);

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

} // namespace ui
