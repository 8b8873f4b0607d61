#pragma once
// How the error of each side falls with time, measured against the reference on a thread of its own.

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "engine/image/metrics.h"
#include "ui/window/locked.h"
#include "ui/window/picture_view.h"

namespace ui
{

struct ErrorPoint {
    double seconds = 0; // of rendering
    uint64_t frames = 0;
    image::Metrics metrics;
};
using ErrorCurve = std::vector<ErrorPoint>; // of one film, times ascending

class ErrorMeter
{
  public:
    explicit ErrorMeter(std::function<void()> wake);

    // Every new reference and every new film starts a new curve; a reference that converges goes on being the same.
    // Points are a few percent of their time apart, and the last is measured again whenever the reference has got
    // better; pictures of a moving camera or scene are not measured.
    void offer(const Pictures& pictures);
    ErrorCurve curve(Side side) const { return copyOf(tracks_[side].curve, mutex_); }
    // Why nothing can be measured; empty: nothing is wrong.
    std::string complaint() const { return copyOf(complaint_, mutex_); }

  private:
    void run(const std::stop_token& stop);
    bool due(Side side) const;
    void measure(std::unique_lock<std::mutex>& lock, Side side);

    struct Track {
        ErrorCurve curve;
        uint64_t run = 0; // of the film
        ReferencePointer reference;
        ShotPointer tried;      // measured last, or found not to be measurable
        ReferencePointer judge; // and against what
    };
    std::function<void()> wake_;
    mutable std::mutex mutex_; // of all up to thread_
    std::condition_variable_any changed_;
    Pictures offered_;
    Track tracks_[SIDES];
    std::string complaint_;
    std::jthread thread_; // last: starts when all else is there
};

} // namespace ui
