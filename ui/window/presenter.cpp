#include "ui/window/presenter.h"

#include "engine/base/error.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_impl_vulkan.h>

namespace ui
{

namespace
{

constexpr VkClearColorValue BACKDROP = {{0.07f, 0.07f, 0.08f, 1.0f}};
constexpr VkImageSubresourceRange WHOLE = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
constexpr VkImageSubresourceLayers LAYER = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};

struct Use { // of an image: how, by which stage
    VkImageLayout layout;
    VkPipelineStageFlags stage;
    VkAccessFlags access;
};
constexpr Use UNDEFINED = {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_TRANSFER_BIT, 0};
constexpr Use WRITTEN = {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_ACCESS_TRANSFER_WRITE_BIT};
constexpr Use READ = {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
                      VK_ACCESS_TRANSFER_READ_BIT};
constexpr Use DRAWN = {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                       VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT};

void change(VkCommandBuffer commands, VkImage image, const Use& from, const Use& to)
{
    const VkImageMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                          .srcAccessMask = from.access,
                                          .dstAccessMask = to.access,
                                          .oldLayout = from.layout,
                                          .newLayout = to.layout,
                                          .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                          .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                          .image = image,
                                          .subresourceRange = WHOLE};
    vkCmdPipelineBarrier(commands, from.stage, to.stage, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

} // namespace

VkDeviceMemory Presenter::allocate(const VkMemoryRequirements& need, VkMemoryPropertyFlags properties) const
{
    VkPhysicalDeviceMemoryProperties kinds;
    vkGetPhysicalDeviceMemoryProperties(physical_, &kinds);
    for (uint32_t i = 0; i < kinds.memoryTypeCount; ++i) {
        if ((need.memoryTypeBits >> i & 1) == 0 || (kinds.memoryTypes[i].propertyFlags & properties) != properties)
            continue;
        const VkMemoryAllocateInfo info = {
            .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = need.size, .memoryTypeIndex = i};
        VkDeviceMemory memory = VK_NULL_HANDLE;
        checkVulkan(vkAllocateMemory(device_, &info, nullptr, &memory), "vkAllocateMemory");
        return memory;
    }
    throw Error("The window's device {} has no memory for a picture.", deviceName_);
}

void Presenter::createBlock(Block& block, VkDeviceSize bytes, VkBufferUsageFlags usage,
                            VkMemoryPropertyFlags properties)
{
    const VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = bytes, .usage = usage};
    checkVulkan(vkCreateBuffer(device_, &info, nullptr, &block.buffer), "vkCreateBuffer");
    VkMemoryRequirements need;
    vkGetBufferMemoryRequirements(device_, block.buffer, &need);
    block.memory = allocate(need, properties);
    checkVulkan(vkBindBufferMemory(device_, block.buffer, block.memory, 0), "vkBindBufferMemory");
}

void Presenter::createSwapchain()
{
    checkVulkan(vkDeviceWaitIdle(device_), "vkDeviceWaitIdle");
    VkSurfaceCapabilitiesKHR can;
    checkVulkan(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(physical_, surface_, &can), "querying the window");
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    destroySwapchain();
    extent_ = can.currentExtent;
    if (extent_.width == UINT32_MAX)
        extent_ = {std::clamp(uint32_t(width), can.minImageExtent.width, can.maxImageExtent.width),
                   std::clamp(uint32_t(height), can.minImageExtent.height, can.maxImageExtent.height)};
    if (extent_.width == 0 || extent_.height == 0) return;
    const uint32_t most = can.maxImageCount > 0 ? can.maxImageCount : UINT32_MAX;
    const VkSwapchainCreateInfoKHR info = {.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
                                           .surface = surface_,
                                           .minImageCount = std::min(can.minImageCount + 1, most),
                                           .imageFormat = format_.format,
                                           .imageColorSpace = format_.colorSpace,
                                           .imageExtent = extent_,
                                           .imageArrayLayers = 1,
                                           .imageUsage =
                                               VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                           .imageSharingMode = VK_SHARING_MODE_EXCLUSIVE,
                                           .preTransform = can.currentTransform,
                                           .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
                                           .presentMode = VK_PRESENT_MODE_FIFO_KHR,
                                           .clipped = VK_TRUE};
    checkVulkan(vkCreateSwapchainKHR(device_, &info, nullptr, &swapchain_), "vkCreateSwapchainKHR");

    uint32_t count = 0;
    vkGetSwapchainImagesKHR(device_, swapchain_, &count, nullptr);
    std::vector<VkImage> images(count);
    checkVulkan(vkGetSwapchainImagesKHR(device_, swapchain_, &count, images.data()), "vkGetSwapchainImagesKHR");
    targets_.resize(count);
    for (size_t i = 0; i < count; ++i) {
        Target& target = targets_[i];
        target.image = images[i];
        const VkImageViewCreateInfo viewInfo = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                                .image = target.image,
                                                .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                                .format = format_.format,
                                                .subresourceRange = WHOLE};
        checkVulkan(vkCreateImageView(device_, &viewInfo, nullptr, &target.view), "vkCreateImageView");
        const VkFramebufferCreateInfo framebufferInfo = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                                         .renderPass = renderPass_,
                                                         .attachmentCount = 1,
                                                         .pAttachments = &target.view,
                                                         .width = extent_.width,
                                                         .height = extent_.height,
                                                         .layers = 1};
        checkVulkan(vkCreateFramebuffer(device_, &framebufferInfo, nullptr, &target.framebuffer),
                    "vkCreateFramebuffer");
        const VkSemaphoreCreateInfo semaphoreInfo = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
        checkVulkan(vkCreateSemaphore(device_, &semaphoreInfo, nullptr, &target.rendered), "vkCreateSemaphore");
    }
}

void Presenter::destroySwapchain()
{
    for (const Target& target : targets_) {
        vkDestroySemaphore(device_, target.rendered, nullptr);
        vkDestroyFramebuffer(device_, target.framebuffer, nullptr);
        vkDestroyImageView(device_, target.view, nullptr);
    }
    targets_.clear();
    vkDestroySwapchainKHR(device_, swapchain_, nullptr);
    swapchain_ = VK_NULL_HANDLE;
}

void Presenter::destroyPicture()
{
    vkDestroyImage(device_, picture_, nullptr);
    vkFreeMemory(device_, pictureMemory_, nullptr);
    vkDestroyBufferView(device_, linearView_, nullptr);
    for (Block* block : {&linear_, &screen_}) {
        vkDestroyBuffer(device_, block->buffer, nullptr);
        vkFreeMemory(device_, block->memory, nullptr);
        *block = {};
    }
    picture_ = VK_NULL_HANDLE;
    pictureMemory_ = VK_NULL_HANDLE;
    linearView_ = VK_NULL_HANDLE;
    pictureExtent_ = {0, 0};
}

void Presenter::createPicture(uint32_t width, uint32_t height)
{
    const VkImageCreateInfo imageInfo = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = VK_FORMAT_R8G8B8A8_UNORM,
        .extent = {width, height, 1},
        .mipLevels = 1,
        .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
    };
    checkVulkan(vkCreateImage(device_, &imageInfo, nullptr, &picture_), "vkCreateImage");
    VkMemoryRequirements need;
    vkGetImageMemoryRequirements(device_, picture_, &need);
    pictureMemory_ = allocate(need, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    checkVulkan(vkBindImageMemory(device_, picture_, pictureMemory_, 0), "vkBindImageMemory");

    const VkDeviceSize pixels = VkDeviceSize{width} * height;
    VkPhysicalDeviceProperties device;
    vkGetPhysicalDeviceProperties(physical_, &device);
    const VkDeviceSize most = std::min<VkDeviceSize>(device.limits.maxTexelBufferElements - 1,
                                                     device.limits.maxStorageBufferRange / sizeof(uint32_t));
    if (pixels > most)
        throw Error("The window's device {} shows at most {} pixels, not {}x{}.", deviceName_, most, width, height);
    createBlock(linear_, (1 + pixels) * sizeof(ScreenPixel), VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT,
                VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    checkVulkan(vkMapMemory(device_, linear_.memory, 0, VK_WHOLE_SIZE, 0, &linearBytes_), "vkMapMemory");
    createBlock(screen_, pixels * sizeof(uint32_t),
                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    const VkBufferViewCreateInfo viewInfo = {.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                             .buffer = linear_.buffer,
                                             .format = VK_FORMAT_R32G32B32A32_UINT,
                                             .range = VK_WHOLE_SIZE};
    checkVulkan(vkCreateBufferView(device_, &viewInfo, nullptr, &linearView_), "vkCreateBufferView");
    const VkDescriptorBufferInfo written = {screen_.buffer, 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet writes[] = {{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                      .dstSet = displaySet_,
                                      .dstBinding = 0,
                                      .descriptorCount = 1,
                                      .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER,
                                      .pTexelBufferView = &linearView_},
                                     {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                      .dstSet = displaySet_,
                                      .dstBinding = 1,
                                      .descriptorCount = 1,
                                      .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                      .pBufferInfo = &written}};
    vkUpdateDescriptorSets(device_, uint32_t(std::size(writes)), writes, 0, nullptr);
    pictureExtent_ = {width, height};
}

void Presenter::setPicture(const ScreenPicture& picture)
{
    checkVulkan(vkWaitForFences(device_, 1, &idle_, VK_TRUE, UINT64_MAX), "vkWaitForFences");
    if (picture.width != pictureExtent_.width || picture.height != pictureExtent_.height) {
        destroyPicture();
        createPicture(picture.width, picture.height);
    }
    std::memcpy(static_cast<ScreenPixel*>(linearBytes_) + 1, picture.pixels.data(),
                picture.pixels.size() * sizeof(ScreenPixel));
    displayDue_ = true;
}

void Presenter::setTone(const Tone& tone)
{
    displayDue_ |= tone != tone_;
    tone_ = tone;
}

void Presenter::recordPicture(VkCommandBuffer commands, VkImage target, const Rectangle& area) const
{
    if (displayDue_) {
        const uint32_t header[] = {pictureExtent_.width, pictureExtent_.height,
                                   std::bit_cast<uint32_t>(std::exp2(tone_.stops)), uint32_t(tone_.curve)};
        static_assert(sizeof(header) == sizeof(ScreenPixel));
        std::memcpy(linearBytes_, header, sizeof(header));
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, display_);
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, displayPipelineLayout_, 0, 1, &displaySet_, 0,
                                nullptr);
        vkCmdDispatch(commands, (pictureExtent_.width + 7) / 8, (pictureExtent_.height + 7) / 8, 1);
        const VkMemoryBarrier shown = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                       .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                                       .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT};
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1,
                             &shown, 0, nullptr, 0, nullptr);
        const VkBufferImageCopy region = {.imageSubresource = LAYER,
                                          .imageExtent = {pictureExtent_.width, pictureExtent_.height, 1}};
        change(commands, picture_, UNDEFINED, WRITTEN);
        vkCmdCopyBufferToImage(commands, screen_.buffer, picture_, WRITTEN.layout, 1, &region);
        change(commands, picture_, WRITTEN, READ);
    }
    const VkImageBlit blit = {
        .srcSubresource = LAYER,
        .srcOffsets = {{0, 0, 0}, {int32_t(pictureExtent_.width), int32_t(pictureExtent_.height), 1}},
        .dstSubresource = LAYER,
        .dstOffsets = {{area.x, area.y, 0}, {area.x + area.width, area.y + area.height, 1}}};
    const bool enlarges = uint32_t(area.width) >= pictureExtent_.width; // pixels stay squares then
    vkCmdBlitImage(commands, picture_, READ.layout, target, WRITTEN.layout, 1, &blit,
                   enlarges ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
}

void Presenter::draw(ImDrawData* widgets, const Rectangle& pictureArea)
{
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    if (width == 0 || height == 0) return;
    if (!swapchain_ || extent_.width != uint32_t(width) || extent_.height != uint32_t(height)) createSwapchain();
    if (!swapchain_) return;

    checkVulkan(vkWaitForFences(device_, 1, &idle_, VK_TRUE, UINT64_MAX), "vkWaitForFences");
    uint32_t index = 0;
    const VkResult acquired = vkAcquireNextImageKHR(device_, swapchain_, UINT64_MAX, acquired_, VK_NULL_HANDLE, &index);
    if (acquired == VK_ERROR_OUT_OF_DATE_KHR) {
        createSwapchain(); // drawn at the next opportunity
        return;
    }
    checkVulkan(acquired, "vkAcquireNextImageKHR");
    const Target& target = targets_[index];

    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    checkVulkan(vkBeginCommandBuffer(commands_, &begin), "vkBeginCommandBuffer");
    change(commands_, target.image, UNDEFINED, WRITTEN);
    vkCmdClearColorImage(commands_, target.image, WRITTEN.layout, &BACKDROP, 1, &WHOLE);
    const bool inside = pictureArea.x >= 0 && pictureArea.y >= 0 && pictureArea.width > 0 && pictureArea.height > 0 &&
                        pictureArea.x + pictureArea.width <= int(extent_.width) &&
                        pictureArea.y + pictureArea.height <= int(extent_.height);
    if (picture_ && inside) {
        change(commands_, target.image, WRITTEN, WRITTEN);
        recordPicture(commands_, target.image, pictureArea);
        displayDue_ = false;
    }
    change(commands_, target.image, WRITTEN, DRAWN);
    const VkRenderPassBeginInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                        .renderPass = renderPass_,
                                        .framebuffer = target.framebuffer,
                                        .renderArea = {{0, 0}, extent_}};
    vkCmdBeginRenderPass(commands_, &pass, VK_SUBPASS_CONTENTS_INLINE);
    ImGui_ImplVulkan_RenderDrawData(widgets, commands_);
    vkCmdEndRenderPass(commands_);
    checkVulkan(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");

    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                 .waitSemaphoreCount = 1,
                                 .pWaitSemaphores = &acquired_,
                                 .pWaitDstStageMask = &stage,
                                 .commandBufferCount = 1,
                                 .pCommandBuffers = &commands_,
                                 .signalSemaphoreCount = 1,
                                 .pSignalSemaphores = &target.rendered};
    checkVulkan(vkResetFences(device_, 1, &idle_), "vkResetFences");
    checkVulkan(vkQueueSubmit(queue_, 1, &submit, idle_), "vkQueueSubmit");
    const VkPresentInfoKHR present = {.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                      .waitSemaphoreCount = 1,
                                      .pWaitSemaphores = &target.rendered,
                                      .swapchainCount = 1,
                                      .pSwapchains = &swapchain_,
                                      .pImageIndices = &index};
    const VkResult presented = vkQueuePresentKHR(queue_, &present);
    if (presented == VK_ERROR_OUT_OF_DATE_KHR || presented == VK_SUBOPTIMAL_KHR)
        createSwapchain();
    else
        checkVulkan(presented, "vkQueuePresentKHR");
}

} // namespace ui
