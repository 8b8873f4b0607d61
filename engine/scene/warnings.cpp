#include "engine/scene/warnings.h"

#include <algorithm>

namespace scene
{

namespace
{
constexpr size_t MAX_SENTENCES = 100; // a broken file can have a different complaint for every object
}

void Warnings::add(const std::string& sentence, size_t count)
{
    const auto known =
        std::find_if(entries_.begin(), entries_.end(), [&](const auto& entry) { return entry.first == sentence; });
    if (known != entries_.end())
        known->second += count;
    else if (entries_.size() < MAX_SENTENCES)
        entries_.emplace_back(sentence, count);
    else
        leftOut_ += count;
}

std::vector<std::string> Warnings::sentences() const
{
    std::vector<std::string> result;
    for (const auto& [sentence, count] : entries_) {
        const std::string stem = sentence.substr(0, sentence.size() - 1);
        result.push_back(count == 1 ? sentence : fmt::format("{} ({} times).", stem, count));
    }
    if (leftOut_ > 0) result.push_back(fmt::format("Left out {} more warnings.", leftOut_));
    return result;
}

} // namespace scene
