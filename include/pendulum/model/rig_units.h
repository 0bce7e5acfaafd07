// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "pendulum/model/rig.h"

namespace pendulum {

/// A unit in which people write a quantity of the rig.
struct RigUnit {
  RigQuantity quantity;
  std::string_view name;  ///< As on the command line; blanks are left out there.
  double si;              ///< Its size in the SI unit.
};

/// All units of the command line. The questions about odd values try those that differ from the SI unit, in this order.
inline constexpr std::array kRigUnits = {
    RigUnit{RigQuantity::kMass, "kg", 1},
    RigUnit{RigQuantity::kMass, "g", 1e-3},
    RigUnit{RigQuantity::kMass, "mg", 1e-6},
    RigUnit{RigQuantity::kMass, "lb", 0.45359237},
    RigUnit{RigQuantity::kMass, "oz", 0.028349523125},
    RigUnit{RigQuantity::kLength, "m", 1},
    RigUnit{RigQuantity::kLength, "cm", 1e-2},
    RigUnit{RigQuantity::kLength, "mm", 1e-3},
    RigUnit{RigQuantity::kLength, "inch", 0.0254},
    RigUnit{RigQuantity::kLength, "in", 0.0254},
    RigUnit{RigQuantity::kLength, "ft", 0.3048},
    RigUnit{RigQuantity::kAcceleration, "m/s^2", 1},
    RigUnit{RigQuantity::kAcceleration, "cm/s^2", 1e-2},
    RigUnit{RigQuantity::kAcceleration, "mm/s^2", 1e-3},
    RigUnit{RigQuantity::kTorque, "N m", 1},
    RigUnit{RigQuantity::kTorque, "N cm", 1e-2},
    RigUnit{RigQuantity::kTorque, "mN m", 1e-3},
    RigUnit{RigQuantity::kStiffness, "N m/rad", 1},
    RigUnit{RigQuantity::kStiffness, "N cm/rad", 1e-2},
    RigUnit{RigQuantity::kStiffness, "mN m/rad", 1e-3},
    RigUnit{RigQuantity::kStiffness, "N m/deg", 57.29577951308232},
    RigUnit{RigQuantity::kStiffness, "N/m", 1},
    RigUnit{RigQuantity::kInertia, "kg m^2", 1},
    RigUnit{RigQuantity::kInertia, "g m^2", 1e-3},
    RigUnit{RigQuantity::kInertia, "kg cm^2", 1e-4},
    RigUnit{RigQuantity::kInertia, "kg mm^2", 1e-6},
    RigUnit{RigQuantity::kInertia, "g cm^2", 1e-7},
    RigUnit{RigQuantity::kInertia, "g mm^2", 1e-9},
    RigUnit{RigQuantity::kInertia, "kg", 1},  // Of a mass on a spring.
};

}  // namespace pendulum
