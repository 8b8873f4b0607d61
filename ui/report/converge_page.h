#pragma once
// What `converge` leaves behind: its table, its plots and its page.

#include <map>
#include <string>
#include <vector>

#include "passes/experiments/race_figures.h"
#include "passes/experiments/reference.h"
#include "ui/cli/method_list.h"
#include "ui/report/page.h"

namespace ui
{

struct ConvergeReport {
    Provenance provenance;
    std::string scene;
    std::vector<passes::NamedMethod> methods;
    uint32_t pt = 0;     // which of them is the path tracer that others are compared with
    bool moving = false; // then pictures are single frames
    std::vector<passes::Repeat> repeats;
    std::map<uint64_t, passes::Reference> references; // passes::References::made
    std::string referenceFile;                        // empty: path traced
    double precision = 0;                             // asked for
    std::vector<image::Image> pictures;               // of the first repeat, by method; empty: there are none yet
};

// converge.csv: a row for every sample of every repeat.
std::string convergeCsv(const ConvergeReport& report);

struct NamedPlot {
    std::string file; // "relmse-seconds.svg"
    std::string caption;
    std::string svg;
};
// None when gnuplot is not installed.
std::vector<NamedPlot> convergePlots(const ConvergeReport& report);

// Plain sentences: which method wins and by how much, or that they cannot be told apart.
std::vector<std::string> convergeVerdicts(const ConvergeReport& report);

std::string convergePage(const ConvergeReport& report, const std::vector<NamedPlot>& plots);

} // namespace ui
