#pragma once
// The GPU layer: WebGPU's vocabulary over Vulkan 1.2 compute. No images, layouts, descriptor pools or barriers show
// here. Objects are move-only values; a Buffer destroyed while in flight is parked until its submission retires. Every
// object carries a label: it names the Vulkan object, its timings, and the nouns of error messages.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/gpu/tuning.h"

namespace gpu
{

struct DeviceState; // everything Vulkan lives behind these (engine/gpu/vulkan.h)
struct BufferState;
struct PipelineState;
struct BindGroupState;
struct EncoderState;

// What the program relies on. Portable by construction: stays inside WebGPU's defaults.
struct Limits {
    uint64_t storageBindingBytes = 0;    // largest storage binding, bytes
    uint64_t tableBytes = 0;             // largest Table, bytes: of a texel buffer, or storageBindingBytes
    uint64_t uniformBindingBytes = 0;    // bytes
    uint32_t storageBuffersPerStage = 0; // count, tables apart
    uint32_t workgroupInvocations = 0;   // count
    uint32_t workgroupBytes = 0;         // shared memory, bytes
    uint64_t memoryBytes = 0;            // largest device-local heap, bytes
    bool timestamps = false;
};

// One physical device that could be used.
struct Adapter {
    std::string name;       // "llvmpipe (LLVM 15.0.6, 256 bits)"
    std::string driver;     // "Mesa 22.3.6"
    std::string kind;       // "cpu", "integrated", "discrete", "virtual", "other"
    std::string apiVersion; // "1.3.230"
    uint32_t index = 0;     // what --device INDEX means
    Limits limits;
    Tuning tuning;
};

// All adapters of the Vulkan loader with a compute queue, in the loader's order. Empty when there is no driver. Throws
// Error: one of them cannot be tuned like that.
std::vector<Adapter> enumerateAdapters(const std::string& tuning = "");

struct DeviceDescriptor {
    std::string adapter;     // index, or part of a name, case-insensitive; empty: discrete before integrated before cpu
    std::string tuning;      // overrides: "NAME=VALUE,..." (engine/gpu/tuning.h)
    bool validation = false; // validation layer with synchronization validation; throws Error when not installed
    std::string
        shaderDirectory; // if set: read and compile GLSL from here at run time (hot reload) instead of embedded SPIR-V
    std::string cacheDirectory; // pipeline cache; empty: none
    double stallSeconds = 300;  // waiting throws Error when no dispatch finishes for so long
    bool robust = false; // accesses outside of buffers do no harm: for contents from a file. Validation implies it
    bool forceStaging = false; // copy to and from the device even where the host sees its memory (tests)
};

enum class Usage : uint32_t {
    Storage = 1,  // shader reads and writes
    Uniform = 2,  // shader reads, uniform block
    Table = 4,    // shader reads and writes rows, uvec4: a texel buffer or a storage buffer (shaders/lib/lanes.glsl)
    Readback = 8, // host reads; copy target
};
constexpr Usage operator|(Usage a, Usage b)
{
    return Usage(uint32_t(a) | uint32_t(b));
}
constexpr bool has(Usage set, Usage one)
{
    return (uint32_t(set) & uint32_t(one)) != 0;
}

// Ends what lies behind an object, where its type is known.
struct Destroy {
    template <class State>
    void operator()(State* state) const;
};

// What all objects are: owners of a state, or of none when they are made without one or moved from.
template <class State>
class Owner
{
  public:
    Owner() = default;
    explicit Owner(std::unique_ptr<State> state) : state_(state.release()) {}
    State* state() const { return state_.get(); }
    std::unique_ptr<State> release() { return std::unique_ptr<State>(state_.release()); }

  private:
    std::unique_ptr<State, Destroy> state_;
};

struct BufferDescriptor {
    std::string label;
    uint64_t size = 0; // bytes; at least 16
    Usage usage = Usage::Storage;
    std::string setting; // the setting to change when it is too large for the device, for the error: "--size"
};

class Buffer : public Owner<BufferState>
{
  public:
    using Owner::Owner;
    uint64_t size() const; // bytes
    const std::string& label() const;
};

// A named specialisation constant; bool is 0 or 1, float by bit pattern.
struct Constant {
    std::string name;
    uint32_t value = 0;
};

struct ComputePipelineDescriptor {
    std::string label;               // also the shader: shaders/<label>.comp, unless `shader` names another
    std::string shader;              // name of an embedded shader, or path of a .spv file (tests)
    std::vector<Constant> constants; // constants that the shader lacks are ignored, so that one list serves all
};

// What the shader itself declares, found by reflection.
struct Binding {
    enum class Kind { Storage, Uniform, Table };
    std::string name; // block name or table name
    uint32_t set = 0;
    uint32_t binding = 0;
    Kind kind = Kind::Storage;
    bool reads = true;
    bool writes = false;
    bool operator==(const Binding&) const = default;
};

Usage usageFor(Binding::Kind kind); // that a buffer must have been created with

class ComputePipeline : public Owner<PipelineState>
{
  public:
    using Owner::Owner;
    const std::string& label() const;
    std::span<const Binding> bindings() const;     // of all sets, sorted by (set, binding)
    std::array<uint32_t, 3> workgroupSize() const; // invocations
    double compileSeconds() const;                 // of pipeline creation, seconds
};

struct BindGroupDescriptor {
    std::string label;
    const ComputePipeline* pipeline =
        nullptr; // whose layout to use; usable with every pipeline whose set declares the same
    uint32_t set = 0;
    std::vector<std::pair<std::string, const Buffer*>>
        buffers; // exactly the names that the shader declares in that set
};

using BindGroup = Owner<BindGroupState>;

struct Threads { // {1000} is 1000 x 1 x 1
    uint32_t x = 1;
    uint32_t y = 1;
    uint32_t z = 1;
};

// One run of a pipeline. A buffer that it writes is bound only once, as in WebGPU.
struct Dispatch {
    const ComputePipeline* pipeline = nullptr;
    std::vector<const BindGroup*> groups; // by set number; null where the pipeline uses no such set
    Threads threads;                      // rounded up to workgroups; the shader guards the rest
    std::string label;                    // of the timing; empty: the pipeline's
    std::string setting;                  // what to reduce when there are too many workgroups, for the error: "--size"
};

// Records work. Barriers are automatic: before a dispatch that touches what an earlier one wrote (or writes what one
// read).
class CommandEncoder : public Owner<EncoderState>
{
  public:
    using Owner::Owner;
    void dispatch(const Dispatch& dispatch);
    void copy(const Buffer& from, const Buffer& to, uint64_t bytes = 0, uint64_t fromOffset = 0, uint64_t toOffset = 0);
    void clear(const Buffer& buffer, uint32_t word = 0); // fills with a 32-bit word
};

using Submission = uint64_t; // grows by one per submit; 0 is "before the first"

// Device time of one label in one submission.
struct Timing {
    std::string label;
    double milliseconds = 0;
};

class Queue
{
  public:
    explicit Queue(DeviceState& device) : device_(&device) {}
    Submission submit(CommandEncoder&& encoder); // throws Error when the device is lost or out of memory
    void wait(Submission submission);            // throws Error when the device is lost or stalls
    bool done(Submission submission) const;
    // Copies now into a staging area; takes effect before the next submit and after all earlier ones.
    void write(const Buffer& buffer, std::span<const std::byte> bytes, uint64_t offset = 0);
    template <class T>
    void writeValue(const Buffer& buffer, const T& value)
    {
        write(buffer, std::as_bytes(std::span(&value, 1)));
    }
    // Blocks until all submitted work is done, then copies out.
    std::vector<std::byte> read(const Buffer& buffer);
    template <class T>
    std::vector<T> readAs(const Buffer& buffer)
    {
        const std::vector<std::byte> bytes = read(buffer);
        std::vector<T> values(bytes.size() / sizeof(T));
        std::copy_n(bytes.data(), values.size() * sizeof(T), reinterpret_cast<std::byte*>(values.data()));
        return values;
    }
    // Asynchronous readback: a copy is enqueued now; `take` the bytes once done(submission), without waiting.
    struct Readback {
        Submission submission = 0;
        Buffer buffer; // Usage::Readback
    };
    Readback readLater(const Buffer& buffer);
    std::vector<std::byte> take(const Readback& readback); // waits if need be
    // What a finished submission took, label by label; once: empty when they were taken, and while it runs. Of the
    // latest thousand submissions.
    std::vector<Timing> takeTimings(Submission submission);

  private:
    DeviceState* device_;
};

// Waits for the queue at its end.
class Device
{
  public:
    static Device create(const DeviceDescriptor& descriptor); // throws Error: no driver, no such adapter
    const Adapter& adapter() const;
    const Limits& limits() const;
    Queue& queue();
    Buffer
    createBuffer(const BufferDescriptor& descriptor); // zero-filled; throws Error naming the setting when too large
    // The one thing that other threads may do at the same time; they hand the pipeline over instead of destroying it.
    ComputePipeline createComputePipeline(const ComputePipelineDescriptor& descriptor);
    BindGroup createBindGroup(const BindGroupDescriptor& descriptor);
    CommandEncoder createCommandEncoder(const std::string& label);

    // Validation messages so far (errors and warnings); empty without validation. Tests require none.
    std::vector<std::string> takeValidationMessages();
    uint64_t allocatedBytes() const; // of live buffers
    void savePipelineCache();        // also on destruction; atomic
    DeviceState& state() { return *state_; }

  private:
    Device() = default;
    std::unique_ptr<DeviceState, Destroy> state_;
};

} // namespace gpu
