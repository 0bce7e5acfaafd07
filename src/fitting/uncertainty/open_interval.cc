// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/uncertainty/open_interval.h"

namespace pendulum {

std::string_view Sentence(OpenInterval open) {
  switch (open) {
    case OpenInterval::kClosed: return "";
    case OpenInterval::kNotDetermined: return "the recording does not determine it beside the others";
    case OpenInterval::kFlatLikelihood: return "the likelihood does not fall far enough on that side, however far out";
    case OpenInterval::kNotFollowed: return "its profile could not be followed; try --interval bootstrap";
    case OpenInterval::kBetterMinimum: return "a better minimum lies within it: the fit is not at the best one";
    case OpenInterval::kAtBound: return "at its bound; --interval profile gives the other end";
    case OpenInterval::kNothingExcluded: return "no value that it may have is excluded";
    case OpenInterval::kFailedResamples: return "too many of the bootstrap's fits cannot be made";
  }
  return "";
}

}  // namespace pendulum
