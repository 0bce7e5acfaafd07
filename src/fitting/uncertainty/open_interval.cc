// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/uncertainty/open_interval.h"

namespace pendulum {

std::string_view Sentence(OpenInterval open) {
  switch (open) {
    case OpenInterval::kClosed: return "";
    case OpenInterval::kNotDetermined: return "the recording does not determine it together with the other parameters";
    case OpenInterval::kFlatLikelihood: return "the likelihood does not fall far enough on that side, at any distance";
    case OpenInterval::kNotFollowed: return "its profile could not be followed; try --interval bootstrap";
    case OpenInterval::kBetterMinimum: return "the interval contains a better minimum, so the fit is not the best one";
    case OpenInterval::kAtBound: return "at its bound; --interval profile gives the other end";
    case OpenInterval::kNothingExcluded: return "the data exclude none of its possible values";
    case OpenInterval::kFailedResamples: return "too many fits of the bootstrap failed";
  }
  return "";
}

}  // namespace pendulum
