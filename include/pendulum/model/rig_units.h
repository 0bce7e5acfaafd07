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
  double factor;          ///< A number in this unit times `factor` and divided by `divisor` is in the SI unit.
  double divisor = 1;     ///< A power of ten, by which a division is exact where a product with 0.01 is not.

  constexpr double ToSi(double number) const { return number * factor / divisor; }
};

/// All units of the command line. The questions about odd values try those that differ from the SI unit, in this order.
inline constexpr std::array kRigUnits = {
    RigUnit{RigQuantity::kMass, "kg", 1},
    RigUnit{RigQuantity::kMass, "g", 1, 1e3},
    RigUnit{RigQuantity::kMass, "mg", 1, 1e6},
    RigUnit{RigQuantity::kMass, "lb", 0.45359237},
    RigUnit{RigQuantity::kMass, "oz", 0.028349523125},
    RigUnit{RigQuantity::kLength, "m", 1},
    RigUnit{RigQuantity::kLength, "cm", 1, 1e2},
    RigUnit{RigQuantity::kLength, "mm", 1, 1e3},
    RigUnit{RigQuantity::kLength, "inch", 0.0254},
    RigUnit{RigQuantity::kLength, "in", 0.0254},
    RigUnit{RigQuantity::kLength, "ft", 0.3048},
    RigUnit{RigQuantity::kAcceleration, "m/s^2", 1},
    RigUnit{RigQuantity::kAcceleration, "cm/s^2", 1, 1e2},
    RigUnit{RigQuantity::kAcceleration, "mm/s^2", 1, 1e3},
    RigUnit{RigQuantity::kTorque, "N m", 1},
    RigUnit{RigQuantity::kTorque, "N cm", 1, 1e2},
    RigUnit{RigQuantity::kTorque, "mN m", 1, 1e3},
    RigUnit{RigQuantity::kStiffness, "N m/rad", 1},
    RigUnit{RigQuantity::kStiffness, "N cm/rad", 1, 1e2},
    RigUnit{RigQuantity::kStiffness, "mN m/rad", 1, 1e3},
    RigUnit{RigQuantity::kStiffness, "N m/deg", 57.29577951308232},
    RigUnit{RigQuantity::kStiffness, "N/m", 1},
    RigUnit{RigQuantity::kInertia, "kg m^2", 1},
    RigUnit{RigQuantity::kInertia, "g m^2", 1, 1e3},
    RigUnit{RigQuantity::kInertia, "kg cm^2", 1, 1e4},
    RigUnit{RigQuantity::kInertia, "kg mm^2", 1, 1e6},
    RigUnit{RigQuantity::kInertia, "g cm^2", 1, 1e7},
    RigUnit{RigQuantity::kInertia, "g mm^2", 1, 1e9},
    RigUnit{RigQuantity::kInertia, "kg", 1},  // Of a mass on a spring.
};

}  // namespace pendulum
