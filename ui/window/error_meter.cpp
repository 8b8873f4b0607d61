#include "ui/window/error_meter.h"

#include "engine/base/error.h"

#include <unistd.h>

namespace ui
{

namespace
{

constexpr double APART = 1.06; // times of neighboring points, as a quotient
constexpr int BACKGROUND = 5;  // nice: after the window's own thread

// A reference that converges stays the same: what its own error adds is subtracted.
bool sameReference(const ReferencePointer& a, const ReferencePointer& b)
{
    return a == b || (a && b && a->converging != 0 && a->converging == b->converging);
}

} // namespace

ErrorMeter::ErrorMeter(std::function<void()> wake)
    : wake_(std::move(wake)), thread_([this](const std::stop_token& stop) { run(stop); })
{
}

void ErrorMeter::offer(const Pictures& pictures)
{
    const std::lock_guard lock(mutex_);
    offered_ = pictures;
    for (const Side side : {A, B}) {
        Track& track = tracks_[side];
        const ShotPointer& shot = pictures.sides[side];
        const bool same = shot && shot->run == track.run && sameReference(track.reference, pictures.reference);
        if (same)
            track.reference = pictures.reference;
        else
            track = {.run = shot ? shot->run : 0, .reference = pictures.reference};
    }
    if (!pictures.reference) complaint_.clear();
    changed_.notify_all();
}

bool ErrorMeter::due(Side side) const
{
    const ShotPointer& shot = offered_.sides[side];
    const Track& track = tracks_[side];
    if (!shot || !offered_.reference || shot->order.moving || shot->order.playing) return false;
    if (offered_.reference != track.judge) return true; // one that converges has got better
    return shot != track.tried && (track.curve.empty() || shot->seconds >= APART * track.curve.back().seconds);
}

void ErrorMeter::run(const std::stop_token& stop)
{
    [[maybe_unused]] const int niceness = nice(BACKGROUND); // of this thread, on Linux
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, stop, [&] { return due(A) || due(B); });
        if (stop.stop_requested()) return;
        for (const Side side : {A, B})
            if (due(side)) measure(lock, side);
    }
}

void ErrorMeter::measure(std::unique_lock<std::mutex>& lock, Side side)
{
    const ShotPointer shot = offered_.sides[side];
    const ReferencePointer reference = offered_.reference;
    ErrorPoint point{.seconds = shot->seconds, .frames = shot->frames};
    std::string complaint;
    lock.unlock();
    try {
        point.metrics = image::without(reference->error, image::measure(reference->picture, shot->picture));
    } catch (const Error& error) {
        complaint = error.what();
    }
    lock.lock();
    complaint_ = complaint;
    Track& track = tracks_[side];
    if (track.run == shot->run && sameReference(track.reference, reference) && complaint.empty()) {
        ErrorCurve& curve = track.curve;
        if (!curve.empty() && point.seconds < APART * curve.back().seconds) curve.pop_back(); // judged better now
        curve.push_back(point);
    }
    track.tried = shot;
    track.judge = reference;
    lock.unlock();
    wake_();
    lock.lock();
}

} // namespace ui
