// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "pendulum/identify/identification.h"
#include "pendulum/report/section.h"

namespace pendulum {

/// The samples and the sampling of each recording; for several recordings a table of them first. Then the rig.
Sections DataSections(const Identification& identification);

/// The sections with the number of recording k, if there are several recordings.
Sections OfRecording(const Identification& identification, std::size_t k, Sections sections);

}  // namespace pendulum
