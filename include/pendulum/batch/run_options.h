// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/swing/choose_swings.h"
#include "pendulum/fitting/swing/fit_swing.h"
#include "pendulum/recording/readers/read_recording.h"

namespace pendulum {

/// What is asked of a recording: how to read it, which of its swings, which models, and how to fit them.
struct RunOptions {
  ReadOptions read;
  SwingChoice swing;
  std::vector<std::string> models;  ///< In the order asked for; several are compared.
  FitOptions fit;                   ///< Its model is the first of them; its rig is that of the recording.
  bool closed_form_only = false;    ///< No fit is made; of `fit`, the model counts.
};

}  // namespace pendulum
