// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "batch/sqlite.h"
#include "pendulum/batch/fit_store.h"

namespace pendulum {

/// Whether the fitted runs of a batch agree. batch: its number in the store.
BatchAgreement AgreementOfBatch(SQLite::Database& database, std::int64_t batch);

}  // namespace pendulum
