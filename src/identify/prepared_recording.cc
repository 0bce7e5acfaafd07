// SPDX-License-Identifier: Apache-2.0
#include "pendulum/identify/prepared_recording.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "pendulum/base/try.h"
#include "pendulum/fitting/likelihood/edge_noise.h"
#include "pendulum/fitting/swing/undersampled.h"
#include "pendulum/model/rig_check.h"
#include "pendulum/model/rig_values.h"
#include "pendulum/recording/readers/read_recording.h"
#include "pendulum/recording/repair_values.h"

namespace pendulum {

Result<PreparedRecording> PrepareRecording(Recording read, const IdentifyOptions& options, std::optional<Rig> rig) {
  std::vector<Warning> notes = options.notes;
  const bool has_file = rig || !read.rig_json.empty();
  if (!rig && (has_file || !options.rig_values.empty())) {
    ASSIGN_OR_RETURN(auto own, has_file ? ParseRigWith(options.rig_values, read.rig_json, read.path + ": # rig", notes)
                                        : RigOfValues(options.rig_values, notes));
    rig = std::move(own);
  }
  if (has_file && !options.rig_values.empty()) notes.push_back(OverrideWarning(options.rig_values));
  if (options.sensor && read.stated_sensor) {
    notes.push_back({.code = "sensor_replaced",
                     .finding = "what --sensor states replaces the line # sensor of the recording",
                     .flags = {"sensor"}});
  }
  PreparedRecording prepared;
  prepared.sensor = options.sensor;
  prepared.samples = read.size();
  // Repairs compare a reading with its neighbours, which an undersampled recording does not allow.
  prepared.recording =
      IsUndersampled(read, rig) ? std::move(read) : WithEdges(RepairValues(std::move(read)), options.fit.noise);
  // The edges of an event-driven recording include samples for its silences.
  prepared.samples = std::max(prepared.samples, prepared.recording.size());
  ASSIGN_OR_RETURN(auto swings, ChooseSwings(prepared.recording, options.swing, rig));
  prepared.swings = std::move(swings);
  prepared.rig = std::move(rig);
  prepared.known.warnings = std::exchange(prepared.recording.warnings, {});
  std::ranges::move(std::exchange(prepared.swings.warnings, {}), std::back_inserter(prepared.known.warnings));
  if (prepared.rig) std::ranges::move(QuestionRig(*prepared.rig), std::back_inserter(prepared.known.warnings));
  std::ranges::move(notes, std::back_inserter(prepared.known.warnings));
  if (!prepared.recording.calibration) return prepared;
  prepared.known.calibration = prepared.recording.calibration->source;
  const Calibration& calibration = *prepared.recording.calibration;
  if (!calibration.note.empty()) {
    prepared.known.warnings.push_back({.code = "calibration_from_table",
                                       .finding = calibration.note,
                                       .assumed = "a straight line through the points of --calibration"});
  }
  if (!calibration.doubt.empty()) {
    prepared.known.warnings.push_back({.code = "calibration_bent",
                                       .finding = calibration.doubt,
                                       .advice =
                                           "make the calibration with calibrate_sensor --order 2 --json, and give "
                                           "its file with --calibration",
                                       .flags = {"calibration"}});
  }
  return prepared;
}

Result<PreparedRecording> PrepareFile(const std::string& path, const IdentifyOptions& options, std::optional<Rig> rig) {
  ASSIGN_OR_RETURN(auto read, ReadRecording(path, ReadOptionsOf(options)));
  return PrepareRecording(std::move(read), options, std::move(rig));
}

tl::unexpected<Status> ErrorOfRun(Status status, const std::string& path, int release) {
  const std::string name = path == "-" ? "standard input" : path;
  const bool is_whole = status.place == name;
  if (release == 0) {
    const bool is_named = is_whole || status.place.starts_with(name + ":");
    return is_named ? tl::unexpected(std::move(status)) : Within(name, std::move(status));
  }
  const std::string swing = name + ": free swing " + std::to_string(release);
  if (!is_whole && !status.place.starts_with(name + ": ")) return Within(swing, std::move(status));
  status.place.replace(0, name.size(), swing);
  return tl::unexpected(std::move(status));
}

}  // namespace pendulum
