#include "ui/report/comparison_page.h"

#include "engine/image/codecs.h"
#include "engine/image/flip.h"
#include "ui/report/crops.h"
#include "ui/report/heat_map.h"
#include "ui/report/page.h"
#include "ui/report/viewer.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace ui
{

namespace
{

constexpr int CROP_SIZE = 48, CROP_COUNT = 3; // pixels squared; per picture
constexpr int CROP_SHOWN = 240;               // pixels on the screen

constexpr const char* STYLE = R"(<style>
.maps { display: grid; grid-template-columns: repeat(auto-fit, minmax(20rem, 1fr)); gap: 0 1rem; }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(24rem, 1fr)); gap: 0 1rem; }
.maps img, .pictures img { width: 100%; image-rendering: pixelated; }
.crops { display: flex; flex-wrap: wrap; gap: .3rem 1rem; } .crops figure { margin: .3rem 0; }
.crops img { image-rendering: pixelated; border: 1px solid #aab3c5; }
.scale { white-space: nowrap; }
</style>
)";

constexpr const char* MEANINGS =
    "MSE, relative MSE (x - r)² / (r² + 0.01) and MAPE |x - r| / (|r| + 0.01) are of linear RGB. PSNR (peak 1), SSIM "
    "(11x11 Gaussian window) and FLIP (LDR-FLIP, 67 pixels per degree; 0 cannot be seen, 1 is green for blue) are of "
    "c/(c+1), what a screen shows. Below 0, where the viewer shows black, PSNR is of c/(1-c); SSIM and FLIP compare "
    "what "
    "is below 0 as a picture of its own, and the worse of a pixel's two counts. Luma and chroma are the squared errors "
    "of "
    "Y and of Co and Cg. Mean ratio is the sum of a channel over the reference's. HDR-FLIP is not computed.";

std::string figure(const std::vector<std::byte>& png, const std::string& captionHtml, int shownWidth = 0)
{
    const std::string width = shownWidth > 0 ? fmt::format(" width=\"{}\"", shownWidth) : "";
    return fmt::format("<figure><img src=\"{}\" alt=\"\"{}><figcaption>{}</figcaption></figure>\n", pngAddress(png),
                       width, captionHtml);
}

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

// All of them at a glance; the first is the reference.
void addPictures(Page& page, const std::vector<ViewerPicture>& shown, const std::vector<ComparedPicture>& pictures)
{
    std::string html = figure(shown.front().png, escapeHtml(shown.front().name) + ", the reference");
    for (size_t i = 0; i < pictures.size(); ++i)
        html += figure(shown[i + 1].png,
                       fmt::format("{}: PSNR {:.2f} dB, relative MSE {:.3g}", escapeHtml(pictures[i].file),
                                   pictures[i].metrics.psnr, pictures[i].metrics.relmse));
    page.raw("<div class=\"pictures\">\n" + html + "</div>\n");
}

void addMaps(Page& page, const image::Image& reference, const image::Image& picture, const image::Plane& flip)
{
    const image::Plane difference = differenceOf(reference, picture),
                       relative = relativeDifferenceOf(reference, picture);
    const double differenceScale = scaleOf(difference);
    const double relativeScale = std::min(scaleOf(relative), 1.0); // fireflies in the dark have no bound
    page.raw("<div class=\"maps\">\n" +
             figure(heatMapPng(flip, 0, 1, ColorMap::Magma), "FLIP " + colorBar(ColorMap::Magma, "0", "1")) +
             figure(heatMapPng(difference, 0, differenceScale, ColorMap::Magma),
                    "Difference of c/(c+1), mean of the channels " +
                        colorBar(ColorMap::Magma, "0", fmt::format("{:.3g}", differenceScale))) +
             figure(heatMapPng(relative, -relativeScale, relativeScale, ColorMap::BlueRed),
                    "Relative difference, (x - r) / (|r| + 0.01) " +
                        colorBar(ColorMap::BlueRed, fmt::format("darker, {:.3g}%", -100 * relativeScale),
                                 fmt::format("+{:.3g}%, brighter", 100 * relativeScale))) +
             "</div>\n");
}

void addCrops(Page& page, const image::Image& reference, const image::Image& picture, const image::Plane& flip)
{
    for (const Crop& crop : worstCrops(flip, CROP_SIZE, CROP_COUNT)) {
        page.paragraph(fmt::format("Pixels {} to {} across, {} to {} down: mean FLIP {:.3f}.", crop.x,
                                   crop.x + crop.width - 1, crop.y, crop.y + crop.height - 1, crop.meanError));
        const int shown = CROP_SHOWN * crop.width / std::max(crop.width, crop.height);
        page.raw("<div class=\"crops\">\n" +
                 figure(image::tonemappedPng(cropped(reference, crop), {}), "reference", shown) +
                 figure(image::tonemappedPng(cropped(picture, crop), {}), "picture", shown) +
                 figure(heatMapPng(cropped(flip, crop), 0, 1, ColorMap::Magma), "FLIP", shown) + "</div>\n");
    }
}

void addSettings(Page& page, const ComparedPicture& reference, const std::vector<ComparedPicture>& pictures)
{
    std::vector<const image::Metadata*> metadata = {&reference.loaded.metadata};
    std::vector<std::string> header = {"setting", reference.file};
    for (const ComparedPicture& picture : pictures) {
        metadata.push_back(&picture.loaded.metadata);
        header.push_back(picture.file);
    }
    const std::vector<std::vector<std::string>> differences = metadataDifferences(metadata);
    page.heading("Settings that differ");
    if (std::ranges::all_of(metadata, [](const auto* m) { return m->empty(); }))
        page.paragraph("The files do not say how they were made.");
    else if (differences.empty())
        page.paragraph("None: by what the files say, the pictures were made alike.");
    else
        page.table(header, differences);
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
    Page page("Pictures compared with " + reference.file);
    page.raw(STYLE);
    for (const std::string& failure : failures) page.verdict(failure);
    std::vector<std::vector<std::string>> rows;
    std::vector<ViewerPicture> shown = {{reference.file, image::tonemappedPng(reference.loaded.image, {})}};
    for (const ComparedPicture& picture : pictures) {
        rows.push_back(figuresOf(picture));
        shown.push_back({picture.file, image::tonemappedPng(picture.loaded.image, {})});
    }
    page.table(figureNames(), rows);
    for (const std::string& warning : reference.loaded.warnings) page.paragraph(warning);
    for (const ComparedPicture& picture : pictures)
        for (const std::string& warning : picture.loaded.warnings) page.paragraph(warning);
    addPictures(page, shown, pictures);
    page.raw(viewerHtml(shown));
    for (const ComparedPicture& picture : pictures) {
        page.heading(picture.file);
        const image::Plane flip = image::flipErrors(reference.loaded.image, picture.loaded.image);
        addMaps(page, reference.loaded.image, picture.loaded.image, flip);
        addCrops(page, reference.loaded.image, picture.loaded.image, flip);
    }
    addSettings(page, reference, pictures);
    page.heading("What the figures are");
    page.paragraph(MEANINGS);
    page.provenance({.command = command});
    return page.html();
}

} // namespace ui
