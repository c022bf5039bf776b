#include "common/report/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "common/result.h"

namespace course::report {

namespace {

// Okabe and Ito, "Color Universal Design", without yellow (too pale for lines) and with black first.
const char* const kColours[] = {"#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};
constexpr int kColourCount = 7;
const int kFilled[] = {7, 5, 9, 13, 11, 15, 7}, kHollow[] = {6, 4, 8, 12, 10, 14, 6};  // gnuplot's marks
constexpr int kPanelsInRow = 3, kPanelHeight = 300;

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

/// Names as gnuplot shows them: in quotes, without its markup.
std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c == '\n' ? ' ' : c;
    }
    return out + "\" noenhanced";
}

/// "RK4, float" is a variant of "RK4": the same colour, other dashes and a hollow mark.
std::string base_of(const std::string& method) {
    return method.substr(0, method.find(", "));
}

struct Look {
    int colour = 0, variant = 0;
};

std::vector<Look> looks_of(const std::vector<Line>& lines) {
    std::vector<std::string> bases;
    std::vector<int> variants;
    std::vector<Look> looks;
    for (const Line& line : lines) {
        const auto found = std::find(bases.begin(), bases.end(), base_of(line.method));
        const int k = int(found - bases.begin());
        if (found == bases.end()) {
            bases.push_back(base_of(line.method));
            variants.push_back(-1);
        }
        looks.push_back({k, ++variants[k]});
    }
    return looks;
}

/// A base name for what the letters of a method's column stand for.
std::string axis_name(const std::string& column) {
    return column == "n" ? "n" : column;
}

const char* const kCommon =
    "set border 3 lc rgb '#52616f'\nset tics nomirror\nset grid back lc rgb '#e1e7ed' lw 1\n"
    "set format y '10^{%L}'\nset logscale y\n";

}  // namespace

std::string plot_script(const StudyData& study) {
    std::string script = kCommon, plot;
    script +=
        "set logscale x\nset format x '10^{%L}'\nset key outside right top Left reverse spacing 1.2 samplen "
        "3\n";
    script +=
        "set xlabel " + quoted(study.error_against_time ? "run time (s)" : axis_name(study.parameter)) + "\n";
    script += "set ylabel " + quoted(study.error_against_time ? study.error_kind : "run time (s)") + "\n";
    if (study.error_against_time && study.error_kind.size() > 48)
        script += "set ylabel 'error'\nset tmargin 3\nset label 1 " + quoted("error: " + study.error_kind) +
                  " at screen 0.02, screen 0.96 left font ',11' tc rgb '#52616f'\n";
    const std::vector<Look> looks = looks_of(study.lines);
    for (std::size_t k = 0; k < study.lines.size(); ++k) {
        std::string rows;
        std::vector<Point> points = study.lines[k].points;
        if (!study.error_against_time)
            std::sort(points.begin(), points.end(),
                      [](const Point& a, const Point& b) { return a.value < b.value; });
        for (const Point& p : points) {
            const double x = study.error_against_time ? p.seconds : p.value;
            const double y = study.error_against_time ? p.error : p.seconds;
            if (!(x > 0 && y > 0) || !std::isfinite(x) || !std::isfinite(y))
                continue;  // has no place on these axes
            rows += number(x) + " " + number(y) + " " + number(p.seconds_low) + " " + number(p.seconds_high) +
                    "\n";
        }
        if (rows.empty()) continue;
        const std::string name = "$line" + std::to_string(k);
        script += name + " << END\n" + rows + "END\n";
        const Look look = looks[k];
        const int c = look.colour % kColourCount;
        const std::string colour = std::string(" lc rgb '") + kColours[c] + "'";
        const std::string dashes = " dt " + std::to_string(1 + look.variant + look.colour / kColourCount);
        const std::string mark = " pt " + std::to_string(look.variant == 0 ? kFilled[c] : kHollow[c]);
        // The bar between the quartiles lies along the axis of time.
        plot += (plot.empty() ? "plot " : ", \\\n     ") + name +
                (study.error_against_time ? " using 1:2:3:4 with xerrorbars pt 0 lw 1"
                                          : " using 1:2:3:4 with yerrorbars pt 0 lw 1") +
                colour + " notitle" + ", " + name + " using 1:2 with linespoints lw 2 ps 1" + colour +
                dashes + mark + " title " + quoted(study.lines[k].method);
    }
    if (plot.empty()) throw std::runtime_error("no row can be drawn on logarithmic axes");
    return script + plot + "\n";
}

int height_of(const StabilityData& data) {
    return 60 + kPanelHeight * int((data.maps.size() + kPanelsInRow - 1) / kPanelsInRow);
}

std::string plot_script(const StabilityData& data) {
    const int panels = int(data.maps.size()), in_row = std::min(panels, kPanelsInRow);
    double low = INFINITY, high = 0;
    for (const MethodMap& map : data.maps)
        for (const Column& column : map.columns)
            for (const Cell& cell : column.cells)
                if (cell.dt > 0) low = std::min(low, cell.dt), high = std::max(high, cell.dt);
    if (!(high > 0)) throw std::runtime_error("no positive time step was tried");
    std::string script = kCommon;
    script += "set multiplot layout " + std::to_string((panels + in_row - 1) / in_row) + "," +
              std::to_string(in_row) + " title " +
              quoted("blue: stable   orange and crossed: unstable   black line: theory") + " font ',12'\n";
    script += "unset grid\nset style fill solid 1 noborder\nset yrange [" + number(low / 1.6) + ":" +
              number(high * 1.6) + "]\nset xlabel " + quoted(data.stiffness) + "\nset ylabel " +
              quoted(data.dt) + "\nunset key\n";
    for (int k = 0; k < panels; ++k) {
        const std::vector<Column>& columns = data.maps[k].columns;
        std::string stable, unstable, crosses, theory, tics;
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const std::vector<Cell>& cells = columns[c].cells;
            tics +=
                (c ? ", " : "") + ("\"" + format_number(columns[c].stiffness)) + "\" " + std::to_string(c);
            for (std::size_t j = 0; j < cells.size(); ++j) {
                if (!(cells[j].dt > 0)) continue;
                // A cell reaches halfway, in logarithms, to the steps below and above it.
                const double below = j > 0 ? std::sqrt(cells[j - 1].dt * cells[j].dt) : cells[j].dt / 1.4;
                const double above =
                    j + 1 < cells.size() ? std::sqrt(cells[j].dt * cells[j + 1].dt) : cells[j].dt * 1.4;
                const std::string box = std::to_string(c) + " " + number(cells[j].dt) + " " +
                                        number(c - 0.46) + " " + number(c + 0.46) + " " + number(below) +
                                        " " + number(above) + "\n";
                (cells[j].stable ? stable : unstable) += box;
                if (!cells[j].stable) crosses += std::to_string(c) + " " + number(cells[j].dt) + "\n";
            }
            theory += number(c - 0.5) + " " + number(columns[c].theory_limit) + "\n" + number(c + 0.5) + " " +
                      number(columns[c].theory_limit) + "\n\n";
        }
        script += "set title " + quoted(data.maps[k].method) +
                  "\nset xrange [-0.6:" + number(columns.size() - 0.4) + "]\nset xtics (" + tics +
                  ") rotate by -35 noenhanced\n";
        std::string plot;
        const auto layer = [&](const char* name, const std::string& rows, const std::string& style) {
            if (rows.empty()) return;
            script += "$" + std::string(name) + std::to_string(k) + " << END\n" + rows + "END\n";
            plot += (plot.empty() ? "plot $" : ", $") + std::string(name) + std::to_string(k) + " " + style;
        };
        layer("stable", stable, "using 1:2:3:4:5:6 with boxxyerror fc rgb '#8ecbee'");
        layer("unstable", unstable, "using 1:2:3:4:5:6 with boxxyerror fc rgb '#e08a4a'");
        layer("crosses", crosses, "using 1:2 with points pt 2 ps 0.6 lc rgb '#6b2f00'");
        layer("theory", theory, "using 1:2 with lines lw 3 lc rgb '#000000'");
        script += plot + "\n";
    }
    return script + "unset multiplot\n";
}

void draw(const std::string& script, const std::filesystem::path& stem, int height_px) {
    const auto size = [&](int width) {
        return " size " + std::to_string(width) + "," + std::to_string(height_px);
    };
    for (const bool svg : {true, false}) {
        const std::string file = stem.string() + (svg ? ".svg" : ".png");
        std::FILE* gnuplot = popen("gnuplot -", "w");
        if (!gnuplot) throw std::runtime_error("gnuplot could not be started");
        std::string head = svg ? "set terminal svg font 'sans,13' background rgb 'white'" + size(960)
                               : "set terminal pngcairo font 'sans,11'" + size(960);
        head += "\nset output " + ("'" + file) + "'\n";
        std::fputs((head + script + "set output\n").c_str(), gnuplot);
        if (pclose(gnuplot) != 0)
            throw std::runtime_error("gnuplot did not draw " + file +
                                     " (is it installed? Debian: gnuplot-nox)");
    }
}

}  // namespace course::report
