// Laws of depth noise, fitted to what patches of a recording scatter.
#pragma once

#include <optional>
#include <vector>

namespace waretwin {

// A number with its 95 % interval.
struct Estimate {
  double value = 0.0, low = 0.0, high = 0.0;
};

// All planar patches seen from about the same range at about the same angle.
struct NoiseCell {
  double range_from_m = 0.0, range_to_m = 0.0;
  double incidence_from_deg = 0.0, incidence_to_deg = 0.0;
  int patches = 0;
  double depth_m = 0.0;       // of the patches about the median one
  double shape = 0.0;         // theirs of time_of_flight_shape
  Estimate sigma_z, sigma_r;  // metres; of the median patch
};

// sigma_z = base + growth * z^2.
struct GaussianLaw {
  Estimate base_m, growth_per_m;  // growth: metres per square metre
  bool at_limit = false;          // the best fit had a negative number; it was set to 0 and the other one fitted alone
  double misfit = 0.0;            // weighted squares of the residuals over the degrees of freedom
  double relative_rms = 0.0;      // root mean square of sigma over its fit - 1
};

// sigma_r = noise_m * sqrt(s + background) / s, with s = illumination * reflectivity * cos(incidence) / range^2.
struct TimeOfFlightLaw {
  Estimate noise_m;
  double misfit = 0.0;
  double relative_rms = 0.0;
};

double time_of_flight_shape(double signal, double background);

// Least squares over the cells, each weighted by the width of its interval and trusted to 2 % at best; where the cells scatter more than
// that about the law, its intervals widen by as much. Nothing where the cells do not determine the law: fewer than three of them (two for
// time of flight), or all at one depth.
std::optional<GaussianLaw> fit_gaussian_law(const std::vector<NoiseCell>& cells);
std::optional<TimeOfFlightLaw> fit_time_of_flight_law(const std::vector<NoiseCell>& cells);

// Median of a sample of variances of `freedom` degrees each as a standard deviation, with its interval by order statistics. A sample of
// normal errors has a median variance a little below its mean (Wilson and Hilferty 1931); that is made good. A negative variance is 0.
Estimate sigma_of_variances(std::vector<double> variances, double freedom);

// The number that a Student variable of `freedom` degrees exceeds in absolute value in 5 % of all cases (Cornish-Fisher expansion about
// the normal one; within 1 % from 3 degrees on).
double student_95(double freedom);

}  // namespace waretwin
