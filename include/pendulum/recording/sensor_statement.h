// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "pendulum/base/status.h"
#include "pendulum/recording/sensor_errors.h"

namespace pendulum {

/// All that SensorErrors::kind may be: "potentiometer", "encoder", "gyro", "accelerometer", "camera", "angle sensor",
/// "ideal".
std::span<const std::string_view> SensorKinds();

bool IsSensorKind(std::string_view text);

/// Reads what is stated about a sensor: one of SensorKinds, or JSON text {"kind": "potentiometer", "gain": 0.003} with
/// at least one of the keys "kind", "gain", "nonlinearity", "lag", "backlash", "drift" and "clock", and optional
/// "schema_version": 1. The numbers, 0 to 10, are the standard deviations of EffectSize; nonlinearity is that of the
/// cubic and of both eccentric terms. null: not stated. kDataLoss: neither, not JSON (line and column), longer than 64
/// KiB, an unknown or repeated key, an unknown kind, or a number out of range. The message begins with `name` and names
/// the key.
Result<SensorStatement> ParseSensorStatement(std::string_view text, const std::string& name, std::string source);

}  // namespace pendulum
