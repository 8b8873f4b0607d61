#include "ui/report/comparison_page.h"

#include "engine/image/codecs.h"
#include "engine/image/flip.h"
#include "ui/report/crops.h"
#include "ui/report/heat_map.h"
#include "ui/report/page.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace ui
{

namespace
{

using Json = nlohmann::json;

constexpr int CROP_SIZE = 48, CROP_COUNT = 3; // pixels squared; per picture
constexpr int CROP_SHOWN = 240;               // pixels on the screen

// The value that all but one in a thousand pixels stay below; above 0.
double scaleOf(const image::Plane& plane)
{
    std::vector<double> sizes = plane.values;
    for (double& size : sizes) size = std::abs(size);
    const auto rank = sizes.begin() + ptrdiff_t(double(sizes.size() - 1) * 0.999);
    std::ranges::nth_element(sizes, rank);
    return *rank > 0 ? *rank : std::max(*std::ranges::max_element(sizes), 1e-12);
}

// Mean over the channels of | difference of c/(c+1) |.
image::Plane differenceOf(const image::Image& reference, const image::Image& picture)
{
    image::Plane result{int(reference.width), int(reference.height), std::vector<double>(reference.pixels.size())};
    for (int c = 0; c < 3; ++c) {
        const image::Plane r = image::tonemapped(reference, c), x = image::tonemapped(picture, c);
        for (size_t i = 0; i < r.values.size(); ++i) result.values[i] += std::abs(x.values[i] - r.values[i]) / 3;
    }
    return result;
}

// (x - r) / (|r| + 0.01) of the mean of the channels.
image::Plane relativeDifferenceOf(const image::Image& reference, const image::Image& picture)
{
    image::Plane result{int(reference.width), int(reference.height), {}};
    const auto mean = [](const glm::vec3& pixel) { return (double(pixel.r) + pixel.g + pixel.b) / 3; };
    for (size_t i = 0; i < reference.pixels.size(); ++i) {
        const double r = mean(reference.pixels[i]);
        result.values.push_back((mean(picture.pixels[i]) - r) / (std::abs(r) + image::RELATIVE_EPSILON));
    }
    return result;
}

// All of them at a glance, and in the viewer; the first is the reference.
Json picturesOf(const ComparedPicture& reference, const std::vector<ComparedPicture>& pictures)
{
    Json list = Json::array();
    const auto add = [&](const ComparedPicture& picture, const std::string& caption) {
        const size_t index = list.size();
        list.push_back({{"index", std::to_string(index)},
                        {"key", index < 10 ? std::to_string(index) : ""},
                        {"name", picture.file},
                        {"caption", picture.file + caption},
                        {"png", pngAddress(image::tonemappedPng(picture.loaded.image, {}))}});
    };
    add(reference, ", the reference");
    for (const ComparedPicture& picture : pictures)
        add(picture,
            fmt::format(": PSNR {:.2f} dB, relative MSE {:.3g}", picture.metrics.psnr, picture.metrics.relmse));
    return list;
}

Json cropsOf(const image::Image& reference, const image::Image& picture, const image::Plane& flip)
{
    Json list = Json::array();
    for (const Crop& crop : worstCrops(flip, glm::ivec2(CROP_SIZE), CROP_COUNT)) {
        const std::string width = std::to_string(CROP_SHOWN * crop.width / std::max(crop.width, crop.height));
        const auto view = [&](const char* what, const std::vector<std::byte>& png) -> Json {
            return {{"what", what}, {"png", pngAddress(png)}, {"width", width}};
        };
        list.push_back({{"left", std::to_string(crop.x)},
                        {"right", std::to_string(crop.x + crop.width - 1)},
                        {"top", std::to_string(crop.y)},
                        {"bottom", std::to_string(crop.y + crop.height - 1)},
                        {"error", fmt::format("{:.3f}", crop.meanError)},
                        {"views",
                         {view("reference", image::tonemappedPng(cropped(reference, crop), {})),
                          view("picture", image::tonemappedPng(cropped(picture, crop), {})),
                          view("FLIP", heatMapPng(cropped(flip, crop), 0, 1, ColorMap::Magma))}}});
    }
    return list;
}

// Where one of them errs: maps and the worst places.
Json comparedWith(const image::Image& reference, const ComparedPicture& compared)
{
    const image::Image& picture = compared.loaded.image;
    const image::Plane flip = image::flipErrors(reference, picture), difference = differenceOf(reference, picture),
                       relative = relativeDifferenceOf(reference, picture);
    const double differenceScale = scaleOf(difference);
    const double relativeScale = std::min(scaleOf(relative), 1.0); // fireflies in the dark have no bound
    const auto map = [](const image::Plane& plane, double low, double high, ColorMap colors) {
        return pngAddress(heatMapPng(plane, low, high, colors));
    };
    return {{"file", compared.file},
            {"flip", map(flip, 0, 1, ColorMap::Magma)},
            {"difference", map(difference, 0, differenceScale, ColorMap::Magma)},
            {"differenceScale", fmt::format("{:.3g}", differenceScale)},
            {"relative", map(relative, -relativeScale, relativeScale, ColorMap::BlueRed)},
            {"relativeScale", fmt::format("{:.3g}", 100 * relativeScale)},
            {"crops", cropsOf(reference, picture, flip)}};
}

} // namespace

std::vector<std::string> figureNames()
{
    return {"image", "MSE", "relMSE", "MAPE", "PSNR dB", "SSIM", "FLIP", "luma MSE", "chroma MSE", "mean ratio R G B"};
}

std::vector<std::string> figuresOf(const ComparedPicture& picture)
{
    const image::Metrics& m = picture.metrics;
    const auto shortly = [](double value) { return fmt::format("{:.4g}", value); };
    return {picture.file,
            shortly(m.mse),
            shortly(m.relmse),
            shortly(m.mape),
            fmt::format("{:.3f}", m.psnr),
            fmt::format("{:.5f}", m.ssim),
            fmt::format("{:.5f}", m.flip),
            shortly(m.lumaMse),
            shortly(m.chromaMse),
            fmt::format("{:.4f} {:.4f} {:.4f}", m.meanRatio.r, m.meanRatio.g, m.meanRatio.b)};
}

std::vector<std::vector<std::string>> metadataDifferences(const std::vector<const image::Metadata*>& metadata)
{
    std::vector<std::string> names; // in the order of the files
    std::vector<std::map<std::string, std::string>> values;
    for (const image::Metadata* list : metadata) {
        values.emplace_back(list->begin(), list->end());
        for (const auto& [name, value] : *list)
            if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
    std::vector<std::vector<std::string>> rows;
    for (const std::string& name : names) {
        std::vector<std::string> row = {name};
        for (const auto& known : values) row.push_back(known.contains(name) ? known.at(name) : "");
        if (std::adjacent_find(row.begin() + 1, row.end(), std::not_equal_to<>()) != row.end()) rows.push_back(row);
    }
    return rows;
}

std::string comparisonPage(const ComparedPicture& reference, const std::vector<ComparedPicture>& pictures,
                           const std::vector<std::string>& failures, const std::string& command)
{
    std::vector<std::vector<std::string>> rows;
    std::vector<std::string> header = {"setting", reference.file}, warnings = reference.loaded.warnings;
    std::vector<const image::Metadata*> metadata = {&reference.loaded.metadata};
    Json compared = Json::array();
    for (const ComparedPicture& picture : pictures) {
        rows.push_back(figuresOf(picture));
        header.push_back(picture.file);
        warnings.insert(warnings.end(), picture.loaded.warnings.begin(), picture.loaded.warnings.end());
        metadata.push_back(&picture.loaded.metadata);
        compared.push_back(comparedWith(reference.loaded.image, picture));
    }
    const std::vector<std::vector<std::string>> differences = metadataDifferences(metadata);
    const bool unknown = std::ranges::all_of(metadata, [](const auto* m) { return m->empty(); });
    return fillPage("{{> compare.html}}",
                    {{"title", "Pictures compared with " + reference.file},
                     {"verdicts", failures},
                     {"figures", tableData(figureNames(), rows)},
                     {"warnings", warnings},
                     {"pictures", picturesOf(reference, pictures)},
                     {"sizes", gradientOf(ColorMap::Magma)},
                     {"signed", gradientOf(ColorMap::BlueRed)},
                     {"compared", compared},
                     {"unknown", unknown},
                     {"alike", !unknown && differences.empty()},
                     {"differences", differences.empty() ? Json(false) : tableData(header, differences)},
                     {"provenance", provenanceData({.command = command})}});
}

} // namespace ui
