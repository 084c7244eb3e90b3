/* Scenario files: which model is seen from where, in which light, as the fidelity tests of <model-viewer> and the Khronos Group write them. */
#ifndef EC_JOBS_SCENARIOS_H
#define EC_JOBS_SCENARIOS_H

#include "jobs/entries.h"

/* Reads {"scenarios": [{"name", "model", "lighting", "dimensions", "target", "orbit", "verticalFoV", "matrix", "toneMapping", "exposure",
 * "renderSkybox"}]}, or "scenarios" as an object by name; "defaults" has values for all. Paths are relative to the file. Each becomes an entry that
 * writes folder/NAME.exr and .png; given options take the place of what a scenario says. What is wrong with one is its why_not; EC_FAILED: with
 * the file. */
ec_result ec_scenarios_read(const char *file, const char *folder, const ec_given_options *given, ec_entries *entries, ec_error *err);

#endif
