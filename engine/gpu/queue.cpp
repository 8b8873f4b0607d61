// Submission and what happens around it: uploads before, readback and timings after, memory given back at the end.

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/gpu/vulkan.h"

#include <algorithm>
#include <cstring>

namespace gpu
{

namespace
{

constexpr size_t MAX_TIMED = 1000; // submissions: a program that never takes its timings must not fill the memory

} // namespace

std::optional<uint64_t> StagingRing::allocate(uint64_t bytes)
{
    CHECK_LE(bytes, BYTES);
    uint64_t begin = head;
    if (begin % BYTES + bytes > BYTES) begin += BYTES - begin % BYTES; // the rest of the lap is too short
    if (begin + bytes > tail + BYTES) return std::nullopt;
    head = begin + bytes;
    return begin % BYTES;
}

// ------------------------------------------------------------------------------------------------- life of submissions

Submission DeviceState::finished() const
{
    uint64_t value = 0;
    vkCheck(vkGetSemaphoreCounterValue(device, timeline, &value), "vkGetSemaphoreCounterValue", "queue");
    return value;
}

void DeviceState::wait(Submission submission)
{
    CHECK_LE(submission, submitted);
    const VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                      .semaphoreCount = 1,
                                      .pSemaphores = &timeline,
                                      .pValues = &submission};
    // Slow work may take its time as long as its command buffers come to their ends. (Queries would tell more, but
    // lavapipe waits for the work when asked whether it is done.)
    VkResult result = VK_TIMEOUT;
    for (std::optional<Submission> before; result == VK_TIMEOUT;) {
        result = waitSemaphores(device, &info, uint64_t(options.stallSeconds * 1e9));
        if (result != VK_TIMEOUT) break;
        const Submission now = finished();
        if (now >= submission) break;
        if (before == now) {
            stalled = true;
            const Flight& flight = *std::ranges::find_if(flights, [&](const Flight& f) { return f.submission > now; });
            throw Error("The Vulkan device \"{}\" stalls in \"{}\": nothing was finished for {} s.",
                        physical.adapter.name, flight.names[now + flight.names.size() - flight.submission],
                        options.stallSeconds);
        }
        before = now;
    }
    if (result != VK_TIMEOUT) vkCheck(result, "vkWaitSemaphores", "queue");
    retire();
}

Submission DeviceState::submit(std::unique_ptr<EncoderState> encoder)
{
    retire();
    Flight flight = {.stagingHead = ring.head};
    const std::unique_ptr<EncoderState> uploads = std::move(pendingWrites);
    for (EncoderState* part : {uploads.get(), encoder.get()}) {
        if (!part) continue;
        part->finish();
        flight.commands.insert(flight.commands.end(), part->commands.begin(), part->commands.end());
        flight.names.insert(flight.names.end(), part->names.begin(), part->names.end());
    }

    // One batch for each command buffer: drivers watch the time of batches, and each tells that it is done.
    const size_t count = std::max<size_t>(flight.commands.size(), 1);
    flight.names.resize(count, "nothing");
    std::vector<uint64_t> values(count);
    std::vector<VkTimelineSemaphoreSubmitInfo> signals(count);
    std::vector<VkSubmitInfo> batches(count);
    for (size_t i = 0; i < count; ++i) {
        values[i] = submitted + 1 + i;
        signals[i] = {.sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                      .signalSemaphoreValueCount = 1,
                      .pSignalSemaphoreValues = &values[i]};
        batches[i] = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                      .pNext = &signals[i],
                      .commandBufferCount = flight.commands.empty() ? 0u : 1u,
                      .pCommandBuffers = flight.commands.empty() ? nullptr : &flight.commands[i],
                      .signalSemaphoreCount = 1,
                      .pSignalSemaphores = &timeline};
    }
    flight.submission = values.back();
    vkCheck(queueSubmit(vkQueue, uint32_t(count), batches.data(), VK_NULL_HANDLE), "vkQueueSubmit",
            encoder ? encoder->label : "writes");
    submitted = flight.submission;

    // The flight owns from here on what the encoders held.
    if (uploads) uploads->commands.clear();
    if (encoder) {
        encoder->commands.clear();
        flight.timestamps = std::exchange(encoder->timestamps, {});
    }
    flights.push_back(std::move(flight));
    return submitted;
}

void DeviceState::park(std::function<void()> destroy)
{
    if (openEncoders == 0 && flights.empty()) return destroy();
    parked.push_back({openEncoders > 0 ? std::nullopt : std::optional(submitted), std::move(destroy)});
}

void DeviceState::retire()
{
    const Submission done = finished();
    while (!flights.empty() && flights.front().submission <= done) {
        Flight& flight = flights.front();
        collect(flight);
        ring.tail = flight.stagingHead;
        recycle(std::move(flight.commands), std::move(flight.timestamps.pages));
        flights.pop_front();
    }
    std::erase_if(parked, [&](Parked& object) {
        if (!object.until && openEncoders == 0) object.until = submitted;
        if (!object.until || *object.until > done) return false;
        object.destroy();
        return true;
    });
}

void DeviceState::collect(const Flight& flight)
{
    const uint32_t bits = physical.timestampBits;
    const uint64_t mask = bits >= 64 ? ~uint64_t{0} : (uint64_t{1} << bits) - 1;
    std::vector<Timing> times;
    for (size_t i = 0; i < flight.timestamps.dispatches.size(); ++i) {
        const Timestamps::Timed& dispatch = flight.timestamps.dispatches[i];
        std::array<uint64_t, 2> ticks = {};
        vkCheck(vkGetQueryPoolResults(device, flight.timestamps.page(i), Timestamps::query(i), 2, sizeof(ticks),
                                      ticks.data(), sizeof(uint64_t),
                                      VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                "vkGetQueryPoolResults", dispatch.label);
        const double milliseconds =
            double((ticks[1] - ticks[0]) & mask) * double(properties.limits.timestampPeriod) * 1e-6;
        *dispatch.groupMilliseconds = milliseconds / double(dispatch.groups);
        const auto same = std::ranges::find(times, dispatch.label, &Timing::label);
        if (same != times.end())
            same->milliseconds += milliseconds;
        else
            times.push_back({dispatch.label, milliseconds});
    }
    if (times.empty()) return;
    timings.emplace(flight.submission, std::move(times));
    if (timings.size() > MAX_TIMED) timings.erase(timings.begin());
}

// ------------------------------------------------------------------------------------------------- things to use again

VkCommandBuffer DeviceState::takeCommandBuffer()
{
    if (!freeCommandBuffers.empty()) {
        const VkCommandBuffer commands = freeCommandBuffers.back();
        freeCommandBuffers.pop_back();
        return commands;
    }
    const VkCommandBufferAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                              .commandPool = commandPool,
                                              .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                              .commandBufferCount = 1};
    VkCommandBuffer commands = VK_NULL_HANDLE;
    vkCheck(vkAllocateCommandBuffers(device, &info, &commands), "vkAllocateCommandBuffers", "command buffer");
    return commands;
}

VkQueryPool DeviceState::takeQueryPage()
{
    if (!freeQueryPages.empty()) {
        const VkQueryPool page = freeQueryPages.back();
        freeQueryPages.pop_back();
        return page;
    }
    const VkQueryPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                        .queryCount = 2 * Timestamps::DISPATCHES_PER_PAGE};
    VkQueryPool page = VK_NULL_HANDLE;
    vkCheck(vkCreateQueryPool(device, &info, nullptr, &page), "vkCreateQueryPool", "timestamps");
    name(VK_OBJECT_TYPE_QUERY_POOL, page, "timestamps");
    return page;
}

void DeviceState::recycle(std::vector<VkCommandBuffer> commands, std::vector<VkQueryPool> pages)
{
    freeCommandBuffers.insert(freeCommandBuffers.end(), commands.begin(), commands.end());
    freeQueryPages.insert(freeQueryPages.end(), pages.begin(), pages.end());
}

EncoderState& DeviceState::writes()
{
    if (!pendingWrites) pendingWrites = std::make_unique<EncoderState>(*this, "writes");
    return *pendingWrites;
}

// --------------------------------------------------------------------------------------------------------------- Queue

Submission Queue::submit(CommandEncoder&& encoder)
{
    CommandEncoder taken = std::move(encoder);
    return device_->submit(taken.release());
}

void Queue::wait(Submission submission)
{
    device_->wait(submission);
}
bool Queue::done(Submission submission) const
{
    return device_->finished() >= submission;
}

void Queue::write(const Buffer& buffer, std::span<const std::byte> bytes, uint64_t offset)
{
    CHECK(buffer.state());
    CHECK_LE(offset, buffer.size());
    CHECK_LE(bytes.size(), buffer.size() - offset);
    if (bytes.empty()) return;
    const BufferState& target = *buffer.state();
    DeviceState& device = *device_;
    device.retire();
    if (target.mapped && device.flights.empty() && !device.pendingWrites) {
        std::memcpy(target.mapped + offset, bytes.data(), bytes.size());
        return;
    }
    if (!device.staging)
        device.staging =
            device.createBuffer({.label = "staging", .size = StagingRing::BYTES, .usage = Usage::Readback});
    constexpr uint64_t PIECE = StagingRing::BYTES / 4;
    while (!bytes.empty()) {
        const std::span piece = bytes.first(std::min<uint64_t>(bytes.size(), PIECE));
        std::optional<uint64_t> place = device.ring.allocate(piece.size());
        while (!place) { // send off what waits, then wait until the oldest has made room
            if (device.pendingWrites) device.submit(nullptr);
            device.wait(device.flights.front().submission);
            place = device.ring.allocate(piece.size());
        }
        std::memcpy(device.staging->mapped + *place, piece.data(), piece.size());
        device.writes().copy(*device.staging, target, {*place, offset, piece.size()});
        offset += piece.size();
        bytes = bytes.subspan(piece.size());
    }
}

std::vector<std::byte> Queue::read(const Buffer& buffer)
{
    CHECK(buffer.state());
    if (!buffer.state()->mapped) return take(readLater(buffer));
    if (device_->pendingWrites) device_->submit(nullptr);
    device_->wait(device_->submitted);
    const std::byte* begin = buffer.state()->mapped;
    return {begin, begin + buffer.size()};
}

Queue::Readback Queue::readLater(const Buffer& buffer)
{
    CHECK(buffer.state());
    Readback readback;
    readback.buffer = Buffer(device_->createBuffer(
        {.label = buffer.label() + " readback", .size = buffer.size(), .usage = Usage::Readback}));
    auto encoder = std::make_unique<EncoderState>(*device_, "read " + buffer.label());
    encoder->copy(*buffer.state(), *readback.buffer.state(), {0, 0, buffer.size()});
    readback.submission = device_->submit(std::move(encoder));
    return readback;
}

std::vector<std::byte> Queue::take(const Readback& readback)
{
    device_->wait(readback.submission);
    CHECK(readback.buffer.state() && readback.buffer.state()->mapped);
    const std::byte* begin = readback.buffer.state()->mapped;
    return {begin, begin + readback.buffer.size()};
}

std::vector<Timing> Queue::takeTimings(Submission submission)
{
    device_->retire();
    const auto node = device_->timings.extract(submission);
    return node ? std::move(node.mapped()) : std::vector<Timing>();
}

} // namespace gpu
