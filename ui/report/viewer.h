#pragma once
// Pictures that a person flips through in a page: by key, by a slider between two, or as their difference.

#include <cstddef>
#include <string>
#include <vector>

namespace ui
{

struct ViewerPicture {
    std::string name;
    std::vector<std::byte> png; // all of one size, tonemapped by c/(c+1)
};

// HTML for Page::raw(), at most once a page; the first picture is the reference, and there is at least one more.
std::string viewerHtml(const std::vector<ViewerPicture>& pictures);

} // namespace ui
