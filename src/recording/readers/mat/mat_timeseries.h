// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "recording/readers/mat/mat_subsystem.h"
#include "recording/readers/mat/mat_table.h"

namespace pendulum {

/// Adds the objects of class timeseries (R2010b and later), each as a run of columns. `ts.Time` has the unit stored in
/// the object. `ts.Data`, or `ts.Data(:,1)` and so on, has the unit stored in the object or, if there is none, the
/// unit in its name. The name is the place where a variable refers to the object, or its property Name, or
/// `timeseries 2`. Objects that cannot be read are skipped with a reason, and so are variables of other classes if
/// there is no timeseries. The properties are those that the class itself declares. This has not yet been verified with
/// a file written by MATLAB.
void AddTimeseries(const MatSubsystem& subsystem, MatTable& table);

}  // namespace pendulum
