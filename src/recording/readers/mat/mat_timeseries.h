// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "recording/readers/mat/mat_subsystem.h"
#include "recording/readers/mat/mat_table.h"

namespace pendulum {

/// Adds the objects of class timeseries (R2010b and later), each a run of columns: `ts.Time`, whose unit it tells,
/// `ts.Data` or `ts.Data(:,1)` and so on, in the unit that it tells, if any, else that of its name. That is where a
/// variable refers to it, or its property Name, or `timeseries 2`. What cannot be read is skipped and says why, and so
/// are variables of other classes where there is no timeseries. The properties are those that the class itself
/// declares; this is not yet proved on a file of MATLAB's own.
void AddTimeseries(const MatSubsystem& subsystem, MatTable& table);

}  // namespace pendulum
