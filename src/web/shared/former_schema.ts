// SPDX-License-Identifier: Apache-2.0
/** Reads results of schema version 1, which stores and files still have, as results of version 2. */

/** Keys and parameters that have other names now. */
const kNames: Readonly<Record<string, string>> = {
  alone: 'separate',
  disagreeing: 'outliers',
  edge_lag: 'hysteresis',
  judged: 'is_compared',
  rest_p: 'p_of_remainder',
  seen_frequency_hz: 'apparent_frequency_hz',
  why: 'reason',
};

/** Codes of warnings that have other names now. */
const kCodes: Readonly<Record<string, string>> = {
  cut_short: 'recording_interrupted',
  disturbed: 'ends_trimmed',
  left_out: 'larger_motion_outside',
  no_end: 'end_message_missing',
  no_part: 'part_file_not_written',
  not_alone: 'separate_fit_not_converged',
  once_a_cycle: 'samples_near_period',
  quiet_sensor: 'noise_below_resolution',
  rig_frequency: 'frequency_differs_from_rig',
  several_versions: 'mixed_versions',
  stop_is_a_kink: 'uncertain_stop',
  trace_accuracy: 'trajectory_accuracy',
  turns_taken_out: 'whole_turns_removed',
  zero_jumps: 'offset_jumps',
  zero_unsteady: 'offset_unsteady',
};

const nameNow = (name: string): string => (Object.hasOwn(kNames, name) ? (kNames[name] ?? name) : name);

function textNow(key: string, text: string): string {
  if (key === 'code') return Object.hasOwn(kCodes, text) ? (kCodes[text] ?? text) : text;
  return text === 'edge_lag' ? nameNow(text) : text;
}

/** `why` and `reason` of version 1 are one sentence now; `reason` often repeated `why`. */
function joined(why: unknown, reason: unknown): unknown {
  if (typeof why !== 'string' || typeof reason !== 'string') return why ?? reason ?? null;
  return reason.includes(why) ? reason : `${why}; ${reason}`;
}

function translate(value: unknown, key: string): unknown {
  if (typeof value === 'string') return textNow(key, value);
  if (Array.isArray(value)) return value.map((item) => translate(item, key));
  if (value === null || typeof value !== 'object') return value;
  const old = value as Record<string, unknown>;
  const renamed = Object.fromEntries(Object.entries(old).map(([name, item]) => [nameNow(name), translate(item, name)]));
  if (Object.hasOwn(old, 'why')) renamed.reason = joined(old.why, old.reason);
  return renamed;
}

/** A result of version 1 with the names of version 2; anything else unchanged. */
export function withCurrentNames(json: unknown): unknown {
  const isFormer =
    json !== null && typeof json === 'object' && 'fits' in json && 'schema_version' in json && json.schema_version === 1;
  return isFormer ? translate(json, '') : json;
}
