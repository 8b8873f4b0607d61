#pragma once
// What settings were before, and what they were before that was undone.

#include <optional>
#include <utility>
#include <vector>

namespace ui
{

template <class State>
class UndoList
{
  public:
    static constexpr size_t MOST = 200; // steps that are kept

    explicit UndoList(State initial) : present_(std::move(initial)) {}

    // To be told of every state; `settled`: no hand is on a widget, so that a slider's way is one step.
    void watch(const State& state, bool settled)
    {
        if (!settled || state == present_) return;
        past_.push_back(std::exchange(present_, state));
        if (past_.size() > MOST) past_.erase(past_.begin());
        future_.clear();
    }
    std::optional<State> undo() { return step(past_, future_); }
    std::optional<State> redo() { return step(future_, past_); }
    bool canUndo() const { return !past_.empty(); }
    bool canRedo() const { return !future_.empty(); }

  private:
    std::optional<State> step(std::vector<State>& from, std::vector<State>& to)
    {
        if (from.empty()) return std::nullopt;
        to.push_back(std::exchange(present_, from.back()));
        from.pop_back();
        return present_;
    }
    State present_;
    std::vector<State> past_, future_;
};

} // namespace ui
