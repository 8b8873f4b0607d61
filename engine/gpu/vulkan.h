#pragma once
// What lies behind gpu.h. Included inside engine/gpu and by its tests only.

#include "engine/gpu/gpu.h"
#include "engine/gpu/hazards.h"

#include <vulkan/vulkan.h>

#include <atomic>
#include <deque>
#include <filesystem>
#include <map>
#include <mutex>

namespace gpu
{

constexpr VkFormat TABLE_FORMAT = VK_FORMAT_R32G32B32A32_UINT; // of tables that are texel buffers
constexpr uint64_t TEXEL_BYTES = 16;

// Out of memory and device loss are the world's faults (Error); any other failure is a bug of ours (CHECK).
void vkCheck(VkResult result, const char* call, const std::string& label);

// A Vulkan instance with its messenger. Not movable: the messenger points at it.
class Instance
{
  public:
    explicit Instance(bool validation); // throws Error: no driver, no validation layer
    ~Instance();                        // unless abandoned

    VkInstance handle() const { return instance_; }
    void abandon() { instance_ = VK_NULL_HANDLE; } // left to the end of the process
    bool canName() const { return canName_; }      // VK_EXT_debug_utils
    std::vector<std::string> takeMessages();
    void addMessage(const std::string& message); // from any thread

  private:
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    bool canName_ = false;
    std::mutex mutex_;
    std::vector<std::string> messages_;
};

// An adapter and what is needed to open it.
struct PhysicalDevice {
    VkPhysicalDevice handle = VK_NULL_HANDLE;
    uint32_t queueFamily = 0;
    uint32_t timestampBits = 0;
    uint64_t texelBytes = 0; // of the largest texel buffer
    DeviceClass deviceClass;
    Adapter adapter;
};
// Chooses by device class, but for the overrides. Throws Error: not possible there.
void tune(PhysicalDevice& device, const std::string& overrides);
std::vector<PhysicalDevice> physicalDevices(VkInstance instance);
// By index or part of the name; empty: discrete, integrated, virtual, cpu, other. Throws Error that lists what there
// is.
const PhysicalDevice& choose(std::span<const PhysicalDevice> devices, const std::string& wanted);

// What must go before its device does.
struct DeviceObject {
    explicit DeviceObject(DeviceState& owner);
    ~DeviceObject();
    DeviceObject(const DeviceObject&) = delete;
    DeviceObject& operator=(const DeviceObject&) = delete;

    DeviceState* device;
    std::string label;
};

struct BufferState : DeviceObject {
    using DeviceObject::DeviceObject;
    ~BufferState(); // parks the Vulkan objects

    uint64_t size = 0; // as asked for; Vulkan's is rounded up to 16
    Usage usage = Usage::Storage;
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkBufferView view = VK_NULL_HANDLE; // of tables that are texel buffers
    uint64_t allocated = 0;
    std::byte* mapped = nullptr; // if the host sees the memory
};

struct PipelineState : DeviceObject {
    using DeviceObject::DeviceObject;
    ~PipelineState();

    std::vector<Binding> bindings;
    std::vector<VkDescriptorSetLayout> setLayouts; // owned by the device
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;
    std::array<uint32_t, 3> workgroupSize = {1, 1, 1};
    double compileSeconds = 0;
    bool storesInStorage = false; // tables, where they are texel buffers (shaders/lib/lanes.glsl)
    // Of a workgroup, the last time; shared with the flights that will know it, which may outlive the pipeline.
    std::shared_ptr<std::optional<double>> groupMilliseconds = std::make_shared<std::optional<double>>();
};

struct BindGroupState : DeviceObject {
    using DeviceObject::DeviceObject;
    ~BindGroupState();

    uint32_t set = 0;
    VkDescriptorSetLayout layout = VK_NULL_HANDLE; // owned by the device
    VkDescriptorPool pool = VK_NULL_HANDLE;        // of this one set
    VkDescriptorSet descriptors = VK_NULL_HANDLE;
    std::map<uint32_t, VkBuffer> buffers; // by binding
};

// Timestamps around the dispatches of one encoder, in pages of fixed size. Dispatch i has queries 2i and 2i + 1.
struct Timestamps {
    static constexpr uint32_t DISPATCHES_PER_PAGE = 64;
    struct Timed {
        std::string label;
        uint64_t groups = 0;
        std::shared_ptr<std::optional<double>> groupMilliseconds; // the pipeline's
    };
    std::vector<VkQueryPool> pages;
    std::vector<Timed> dispatches;
    VkQueryPool page(size_t dispatch) const { return pages[dispatch / DISPATCHES_PER_PAGE]; }
    static uint32_t query(size_t dispatch) { return uint32_t(2 * (dispatch % DISPATCHES_PER_PAGE)); } // its begin
};

// Drivers of graphics cards reset a device whose work takes seconds, and a desktop on it freezes meanwhile. So long
// dispatches are cut into bands of workgroups, and long command buffers into several, each submitted on its own.
constexpr double LONGEST_MILLISECONDS = 500; // that a command buffer is expected to take
constexpr uint32_t FIRST_BANDS = 16;         // of a dispatch whose time is not known yet

struct EncoderState {
    EncoderState(DeviceState& owner, const std::string& label);
    ~EncoderState(); // an encoder that was never submitted gives its things back
    EncoderState(const EncoderState&) = delete;
    EncoderState& operator=(const EncoderState&) = delete;

    void beforeWork(std::span<const BufferUse<VkBuffer>> uses); // the barrier, if one is needed
    void dispatch(const Dispatch& dispatch);
    void copy(const BufferState& from, const BufferState& to, const VkBufferCopy& region);
    void fill(const BufferState& buffer, uint32_t word);
    void finish(); // ends recording

    DeviceState* device;
    std::string label;
    std::vector<VkCommandBuffer> commands; // the last one is being recorded
    std::vector<std::string> names;        // of the dispatches in each, or the encoder's
    HazardTracker<VkBuffer> hazards;
    Timestamps timestamps;

  private:
    void begin(); // the next command buffer
    void dispatchInBands(const PipelineState& pipeline, const Dispatch& dispatch, const std::array<uint32_t, 3>& groups,
                         const std::string& name);
    void timestamp(uint32_t query);
    VkCommandBuffer current() const { return commands.back(); }

    double milliseconds_ = 0; // that the current command buffer is expected to take
};

// Work that the queue has been given and that is not known to be done.
struct Flight {
    Submission submission = 0;
    std::vector<VkCommandBuffer> commands; // at least one submission each; the last one is `submission`
    std::vector<std::string> names;        // of what each does
    Timestamps timestamps;
    uint64_t stagingHead = 0; // the ring is free up to here once this has finished
};

// A ring of host-visible memory that Queue::write copies through. Positions only grow; modulo gives the offset.
struct StagingRing {
    static constexpr uint64_t BYTES = uint64_t{8} << 20;
    // The offset of `bytes` bytes in one piece, or nothing when work in flight still reads that part.
    std::optional<uint64_t> allocate(uint64_t bytes);
    uint64_t head = 0;
    uint64_t tail = 0;
};

struct DeviceState {
    DeviceState(const DeviceDescriptor& descriptor);
    ~DeviceState();

    // Destroys now, or when all submitted and all currently recorded work has finished.
    void park(std::function<void()> destroy);
    void retire(); // notes what has finished: timings, parked objects, staging memory
    Submission finished() const;
    Submission submit(std::unique_ptr<EncoderState> encoder); // null: only pending writes
    void wait(Submission submission);
    EncoderState& writes(); // the encoder of pending writes

    std::unique_ptr<BufferState> createBuffer(const BufferDescriptor& descriptor);
    std::vector<uint32_t> loadShader(const std::string& shader) const; // compiled here and now for hot reload
    VkDescriptorSetLayout setLayout(const std::map<uint32_t, VkDescriptorType>& bindings);
    std::map<uint32_t, VkDescriptorType> descriptorsOf(const Binding& binding) const; // by number
    bool tablesAreTexelBuffers() const { return physical.adapter.tuning.tables == Tuning::Tables::Texel; }
    VkCommandBuffer takeCommandBuffer();
    VkQueryPool takeQueryPage();
    void recycle(std::vector<VkCommandBuffer> commands, std::vector<VkQueryPool> pages);
    void name(VkObjectType type, uint64_t handle, const std::string& label) const;
    std::filesystem::path cachePath() const;
    void loadPipelineCache();
    void savePipelineCache();
    template <class Handle>
    void name(VkObjectType type, Handle handle, const std::string& label) const
    {
        name(type, reinterpret_cast<uint64_t>(handle), label);
    }

    DeviceDescriptor options;
    Instance instance;
    PhysicalDevice physical;
    VkPhysicalDeviceProperties properties = {};
    VkPhysicalDeviceMemoryProperties memoryProperties = {};
    VkDevice device = VK_NULL_HANDLE;
    VkQueue vkQueue = VK_NULL_HANDLE;
    VkCommandPool commandPool = VK_NULL_HANDLE;
    VkSemaphore timeline = VK_NULL_HANDLE;          // its value is the last finished submission
    VkPipelineCache pipelineCache = VK_NULL_HANDLE; // null without a cache folder
    std::vector<std::byte> savedCache;              // the blob that the file holds
    Queue queue{*this};

    Submission submitted = 0;
    uint32_t openEncoders = 0;
    std::atomic<uint32_t> liveObjects = 0; // buffers, pipelines, bind groups; must be 0 at the end
    uint64_t allocatedBytes = 0;

    std::deque<Flight> flights;
    struct Parked {
        std::optional<Submission> until; // not yet known while an encoder may hold the object
        std::function<void()> destroy;
    };
    std::vector<Parked> parked;
    std::vector<VkCommandBuffer> freeCommandBuffers;
    std::vector<VkQueryPool> freeQueryPages;
    std::map<Submission, std::vector<Timing>> timings; // of finished ones, until they are taken
    bool stalled = false;                              // for good: nothing can be waited for or destroyed
    std::unique_ptr<EncoderState> pendingWrites;
    StagingRing ring;
    std::unique_ptr<BufferState> staging;
    std::mutex setLayoutsMutex; // pipelines are created by several threads
    std::map<std::map<uint32_t, VkDescriptorType>, VkDescriptorSetLayout> setLayouts;

    // Replaceable, so that a test can lose the device. (tests/faults/faulty_calls.cpp makes any call fail.)
    PFN_vkQueueSubmit queueSubmit = vkQueueSubmit;
    PFN_vkWaitSemaphores waitSemaphores = vkWaitSemaphores;
    PFN_vkCmdBeginDebugUtilsLabelEXT beginLabel = nullptr;
    PFN_vkCmdEndDebugUtilsLabelEXT endLabel = nullptr;
    PFN_vkSetDebugUtilsObjectNameEXT setName = nullptr;

  private:
    struct WithoutDevice {
    };
    DeviceState(const DeviceDescriptor& descriptor, WithoutDevice);
    void collect(const Flight& flight);
};

} // namespace gpu
