/// @file
/// Sentences that follow from measured rows: nobody types a conclusion, so none can outlive its data.
#pragma once
#include <string>

#include "common/report/measurements.h"

namespace course::report {

/// Seconds in which the method gets an error of at most `error`: between measured points by a straight line
/// in logarithms. Infinite if it never does; never extrapolated.
double seconds_for_error(const Line& line, double error);

/// Which method is the cheapest at each decade of error, by how much, and whose error meets a floor; or, for
/// a study of cost, how time grows with the parameter and who is fastest where.
std::string conclusion(const StudyData& study);

/// How far the measured limits are from the theory's.
std::string conclusion(const StabilityData& data);

}  // namespace course::report
