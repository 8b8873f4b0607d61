#pragma once
// How the error of each side falls with time, measured against the reference on a thread of its own.

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "engine/image/metrics.h"
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
    ~ErrorMeter();
    ErrorMeter(const ErrorMeter&) = delete;
    ErrorMeter& operator=(const ErrorMeter&) = delete;

    // Every new reference and every new film starts a new curve; a reference that converges goes on being the same.
    // Points are a few percent of their time apart, and the last is measured again whenever the reference has got
    // better; pictures of a moving camera are not measured.
    void offer(const Pictures& pictures);
    ErrorCurve curve(Side side) const;
    std::string complaint() const; // why nothing can be measured; empty: nothing is wrong

  private:
    void run();
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
    std::condition_variable changed_;
    Pictures offered_;
    Track tracks_[SIDES];
    std::string complaint_;
    bool stop_ = false;
    std::thread thread_; // last: starts when all else is there
};

} // namespace ui
