// Taking a renderer's state out and putting it back.

#include "passes/renderer.h"

#include "engine/base/error.h"

#include <algorithm>

namespace passes
{

std::vector<const gpu::Buffer*> Renderer::lastingBuffers() const
{
    std::vector<const gpu::Buffer*> list = buffers_.lasting();
    list.insert(list.begin(), &counters_);
    return list;
}

RendererState Renderer::save()
{
    wait();
    RendererState state{.frames = frameCount_,
                        .historyFrames = historyFrames_,
                        .camera = frame_.camera,
                        .previousCamera = frame_.previousCamera};
    for (const gpu::Buffer* buffer : lastingBuffers()) {
        std::vector<std::byte> bytes = device_.queue().read(*buffer);
        if (buffer == &buffers_["Surfaces"] && frame_.slice == 1) // the last frame's half goes first
            std::rotate(bytes.begin(), bytes.begin() + std::ptrdiff_t(bytes.size() / 2), bytes.end());
        state.buffers.emplace_back(buffer->label(), std::move(bytes));
    }
    return state;
}

void Renderer::restore(const RendererState& state)
{
    const std::vector<const gpu::Buffer*> buffers = lastingBuffers();
    if (state.buffers.size() != buffers.size())
        throw Error("A state of {} buffers does not fit a renderer that keeps {}.", state.buffers.size(),
                    buffers.size());
    for (size_t i = 0; i < buffers.size(); ++i) {
        const auto& [name, bytes] = state.buffers[i];
        if (name != buffers[i]->label() || bytes.size() != buffers[i]->size())
            throw Error("A state with {} bytes of \"{}\" does not fit a renderer with {} bytes of \"{}\".",
                        bytes.size(), name, buffers[i]->size(), buffers[i]->label());
    }
    reset();
    for (size_t i = 0; i < buffers.size(); ++i) device_.queue().write(*buffers[i], state.buffers[i].second);
    frameCount_ = state.frames;
    historyFrames_ = state.historyFrames;
    frame_.camera = state.camera;
    frame_.previousCamera = state.previousCamera;
    frame_.slice = 0; // save() has put the last frame's half of surfaces_ there
    hitsFrom_.reset();
    if (frameCount_ > 0 && std::ranges::find(buffers, &buffers_["Surfaces"]) != buffers.end())
        hitsFrom_ = state.previousCamera;
}

} // namespace passes
