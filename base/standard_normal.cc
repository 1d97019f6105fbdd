#include "base/standard_normal.h"

#include <boost/math/distributions/normal.hpp>

namespace softland {

double standard_normal_cdf(double z) { return cdf(boost::math::normal_distribution<>(), z); }
double standard_normal_quantile(double p) { return quantile(boost::math::normal_distribution<>(), p); }

}  // namespace softland
