/// @file
/// What a table of measurements says: where one model overtakes the other, and what its time follows.
#pragma once
#include <cmath>
#include <vector>

namespace compared {

/// Points where two curves over the same x cross, between measured points by straight lines in logarithms.
/// @param x, a, b  positive, x ascending, as many of each
//! [crossings]
inline std::vector<double> crossings(const std::vector<double>& x, const std::vector<double>& a,
                                     const std::vector<double>& b) {
    std::vector<double> places;
    for (std::size_t k = 0; k + 1 < x.size(); ++k) {
        const double before = std::log(a[k] / b[k]), after = std::log(a[k + 1] / b[k + 1]);
        if ((before < 0) == (after < 0)) continue;
        const double t = before / (before - after);
        places.push_back(x[k] * std::pow(x[k + 1] / x[k], t));
    }
    return places;
}
//! [crossings]

/// A straight line through points by least squares.
struct LineFit {
    double intercept = 0, slope = 0;
    double explained = 0;  ///< R^2: the part of y's variance that the line explains; 0 where nothing varies
};

//! [fit_line]
inline LineFit fit_line(const std::vector<double>& x, const std::vector<double>& y) {
    const double n = double(x.size());
    double mean_x = 0, mean_y = 0, xx = 0, xy = 0, yy = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        mean_x += x[k] / n;
        mean_y += y[k] / n;
    }
    for (std::size_t k = 0; k < x.size(); ++k) {
        xx += (x[k] - mean_x) * (x[k] - mean_x);
        xy += (x[k] - mean_x) * (y[k] - mean_y);
        yy += (y[k] - mean_y) * (y[k] - mean_y);
    }
    LineFit fit;
    if (xx > 0) fit.slope = xy / xx;
    fit.intercept = mean_y - fit.slope * mean_x;
    if (xx > 0 && yy > 0) fit.explained = xy * xy / (xx * yy);
    return fit;
}
//! [fit_line]

/// The power p of y ~ x^p, by a line through logarithms.
inline double growth_exponent(std::vector<double> x, std::vector<double> y) {
    for (double& value : x) value = std::log(value);
    for (double& value : y) value = std::log(value);
    return fit_line(x, y).slope;
}

}  // namespace compared
