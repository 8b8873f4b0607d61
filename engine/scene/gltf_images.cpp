#include "engine/scene/gltf_images.h"

#include <atomic>
#include <exception>
#include <thread>

#include "engine/base/error.h"
#include "engine/scene/gltf_materials.h"
#include "engine/scene/texture_image.h"

namespace scene::gltf
{

namespace
{

constexpr uint64_t MAX_TOTAL_PIXELS = uint64_t{1} << 30; // of all images of a scene

} // namespace

std::vector<Image> readImages(const Document& document, std::vector<Material>& materials,
                              std::vector<std::filesystem::path>& files, const std::function<void(double)>& progress)
{
    std::vector<uint32_t> newIndex(document.images.size(), NONE), used;
    for (Material& material : materials) {
        eachTexture(material, [&](TextureUse& use) {
            uint32_t& index = newIndex[use.image];
            if (index == NONE) {
                index = static_cast<uint32_t>(used.size());
                used.push_back(use.image);
            }
            use.image = index;
        });
    }

    // The failure reported is that of the first image in order, whichever thread meets one first.
    std::vector<Image> images(used.size());
    std::vector<std::exception_ptr> failures(used.size());
    std::atomic<size_t> next = 0, done = 0;
    std::atomic<uint64_t> pixels = 0;
    const auto work = [&](bool reports) {
        for (size_t i = next++; i < used.size(); i = next++) {
            try {
                const ImageSource& source = document.images[used[i]];
                images[i] = source.bufferView >= 0 ? decodeTexture(document.view(source.bufferView), source.name)
                                                   : decodeTexture(readUri(source.uri, document.folders), source.name);
                pixels += uint64_t{images[i].width} * images[i].height;
                if (pixels > MAX_TOTAL_PIXELS)
                    throw Error("The images have more than {} pixels together.", MAX_TOTAL_PIXELS);
            } catch (...) {
                failures[i] = std::current_exception();
                next = used.size();
            }
            ++done;
            if (reports && progress) progress(static_cast<double>(done) / static_cast<double>(used.size()));
        }
    };
    std::thread helper(work, false);
    work(true);
    helper.join();
    for (const std::exception_ptr& failure : failures) {
        if (failure) std::rethrow_exception(failure);
    }
    for (const uint32_t index : used) {
        const ImageSource& source = document.images[index];
        if (const auto file = source.bufferView < 0 ? fileOf(source.uri, document.folders) : std::nullopt)
            files.push_back(*file);
    }
    return images;
}

} // namespace scene::gltf
