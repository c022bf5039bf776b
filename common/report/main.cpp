/// @file
/// course_report FOLDER PAGE: draws every study and stability map below FOLDER (FOLDER/NN_topic/study_*.json
/// and stability_*.json) and writes PAGE, which shows them with their tables and conclusions.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/errors.h"
#include "common/files.h"
#include "common/html.h"
#include "common/report/conclusion.h"
#include "common/report/plot.h"
#include "common/result.h"

namespace {

using namespace course;
using namespace course::report;
namespace fs = std::filesystem;

std::string cells(const char* tag, const std::vector<std::string>& texts) {
    std::string html = "<tr>";
    for (const std::string& text : texts)
        html += std::string("<") + tag + ">" + escape_html(text) + "</" + tag + ">";
    return html + "</tr>\n";
}

std::string paragraphs(const std::string& lines) {
    std::string html;
    for (char c : escape_html(lines)) html += c == '\n' ? "<br>" : std::string(1, c);
    return html;
}

std::string percent(double share) {
    return format_number(std::round(1000 * share) / 10) + " %";
}

std::string table_of(const StudyData& study) {
    std::string html = "<table><caption>Error: " + escape_html(study.error_kind) + "</caption>" +
                       cells("th", {"method", study.parameter, "n", "error", "seconds", "spread"});
    for (const Line& line : study.lines)
        for (const Point& p : line.points)
            html += cells(
                "td", {line.method, format_number(p.value), format_number(p.n),
                       std::isfinite(p.error) ? format_number(p.error) : "unstable", format_number(p.seconds),
                       percent((p.seconds_high - p.seconds_low) / p.seconds)});
    return html + "</table>";
}

std::string table_of(const StabilityData& data) {
    std::string html =
        "<table><caption>Stable: " + escape_html(data.criterion) + ". Theory: " + escape_html(data.theory) +
        "</caption>" +
        cells("th", {"method", data.stiffness, "measured limit", "theory", "measured / theory"});
    for (const MethodMap& map : data.maps)
        for (const Column& column : map.columns) {
            const bool bracketed = std::isfinite(column.measured_limit);
            html +=
                cells("td", {map.method, format_number(column.stiffness),
                             bracketed ? format_number(column.measured_limit) : "none met",
                             format_number(column.theory_limit),
                             bracketed ? format_number(column.measured_limit / column.theory_limit) : ""});
        }
    return html + "</table>";
}

/// The command that measures it again, as a reader types it. The file is called study_NAME.json or
/// stability_NAME.json.
std::string command_of(const Origin& origin, const fs::path& json) {
    const std::string file = json.filename().string();
    return "./course run " + origin.chapter.substr(0, 2) + " --" + file.substr(0, file.find('_')) + " " +
           origin.name + (origin.quick ? " --quick" : "");
}

/// Draws it, and returns its part of the page.
template <class Data>
std::string section(const Data& data, const fs::path& json, const std::string& link, int height_px) {
    draw(plot_script(data), fs::path(json).replace_extension(), height_px);
    const Origin& o = data.origin;
    return "<h3 id=\"" + escape_html(o.chapter + "_" + o.name) + "\">" + escape_html(o.question) +
           "</h3>\n<figure class=\"wide\"><a href=\"" + link + ".svg\"><img src=\"" + link + ".svg\" alt=\"" +
           escape_html(o.question) + "\"></a></figure>\n<p class=\"conclusion\">" +
           paragraphs(conclusion(data)) + "</p>\n<p><code>" + escape_html(command_of(o, json)) +
           "</code> &middot; backend: " + escape_html(o.backend) + ", " + escape_html(o.device) +
           (o.quick ? " &middot; quick: few and small points" : "") + " &middot; <a href=\"" + link +
           ".csv\">CSV</a>, <a href=\"" + link +
           ".png\">PNG</a></p>\n<details><summary>The numbers</summary>" + table_of(data) + "</details>\n";
}

/// The JSON files of studies and maps, by chapter, studies first.
std::vector<fs::path> measurements_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& chapter : fs::directory_iterator(folder)) {
        if (!chapter.is_directory()) continue;
        for (const auto& file : fs::directory_iterator(chapter)) {
            const std::string name = file.path().filename().string();
            const bool measured = name.rfind("study_", 0) == 0 || name.rfind("stability_", 0) == 0;
            if (measured && file.path().extension() == ".json") files.push_back(file.path());
        }
    }
    std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
        const auto key = [](const fs::path& p) {
            return std::make_tuple(p.parent_path(), p.filename().string().rfind("stability_", 0) == 0, p);
        };
        return key(a) < key(b);
    });
    return files;
}

int write_report(const fs::path& folder, const fs::path& page) {
    const std::vector<fs::path> files = measurements_in(folder);
    if (files.empty()) throw BadInput("no study and no stability map in " + folder.string());
    std::string html =
        html_head("Error against run time",
                  "Every study and every stability map of the course, measured on this machine. Each "
                  "conclusion is computed from the numbers below its plot. Times with the backend "
                  "'simulator' are those of a CPU running the kernels and say nothing about a GPU.");
    std::string chapter;
    int status = 0;
    for (const fs::path& json : files) {
        try {
            const std::string link = fs::relative(json, page.has_parent_path() ? page.parent_path() : ".")
                                         .replace_extension()
                                         .string();
            const std::string part = json.filename().string().rfind("study_", 0) == 0
                                         ? section(load_study(json), json, escape_html(link), kStudyHeight)
                                         : [&] {
                                               const StabilityData data = load_stability(json);
                                               return section(data, json, escape_html(link), height_of(data));
                                           }();
            if (const std::string of = json.parent_path().filename().string(); of != chapter) {
                chapter = of;
                html += "<h2>" + escape_html(chapter) + "</h2>\n";
            }
            html += part;
        } catch (const std::exception& error) {  // one bad file must not hide the others
            std::fprintf(stderr, "course_report: left out %s: %s\n", json.string().c_str(), error.what());
            html += "<p class=\"failed\">Left out: " + escape_html(json.filename().string()) + ": " +
                    escape_html(error.what()) + "</p>\n";
            status = 2;
        }
    }
    write_file(page, html + "</body></html>\n");
    return status;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: course_report FOLDER PAGE\n");
        return 2;
    }
    try {
        return write_report(argv[1], argv[2]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "course_report: %s\n", error.what());
        return 2;
    }
}
