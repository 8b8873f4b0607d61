#pragma once
// What shift maps owe on a real scene: identities at home, T after its inverse, J times its inverse, and J against the
// random numbers themselves, differentiated numerically.
//
// A path is a point u of primary sample space. Shifted by T it is again what a walk in the other domain would draw, for
// other random numbers u'. They are found (lobe_numbers.h), the product draws the path from them, shifts it back, and
// u' is differentiated by u. Several u draw the same path where lobes overlap, so that |du'/du| is a quotient of
// measures. Paths are kept from x_r on: u' differs from u in what draws x_r and, after it, x_(r+1).

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/shift_lab.h"

namespace support
{

// How far off each path is in one respect, relatively; 1 where it is not even defined.
struct Tally {
    static constexpr double TOLERANCE = 1e-3;
    std::vector<double> errors;

    void add(double error);
    size_t wrong() const; // beyond the tolerance
    double quantile(double share) const;
};

struct ShiftFindings {
    Tally home;      // into the own domain: f(T Y) = f(Y)
    Tally back;      // T after its inverse: f(T^-1 T Y) = f(Y)
    Tally product;   // J times its inverse
    Tally jacobian;  // f(T Y) / p(Y), what merges take, is the contribution of u' times the numeric |du'/du|
    Tally density;   // which the sample carries on, of the path that is drawn there
    Tally undefined; // 1 where T is not defined, but its inverse is
    std::map<std::string, size_t> kinds; // of defined shifts: how many
    std::map<int, size_t> outcomes;      // SHIFT_*; else a shift was not counted as one thing

    std::vector<std::pair<const char*, const Tally*>> tallies() const;
};

// Of all paths of `treesPerPixel` trees of every pixel that the map shifts at all, each into a pixel nearby.
ShiftFindings findingsOf(ShiftLab& lab, passes::Shift shift, uint32_t treesPerPixel);

} // namespace support
