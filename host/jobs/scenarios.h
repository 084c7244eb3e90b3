/* Reads scenario files: which model is seen from where, in which light, in the form of the fidelity tests of <model-viewer> and the Khronos Group. */
#ifndef EC_JOBS_SCENARIOS_H
#define EC_JOBS_SCENARIOS_H

#include "jobs/entries.h"

/* Reads {"scenarios": [{"name", "model", "lighting", "dimensions", "target", "orbit", "verticalFoV", "matrix", "toneMapping", "exposure",
 * "renderSkybox"}]}, or "scenarios" as an object by name; "defaults" has values for all. Paths are relative to the file. Each scenario becomes an
 * entry that writes folder/NAME.exr and .png; options in `given` override it. An invalid scenario sets why_not of its entry; an invalid file returns
 * EC_FAILED. */
ec_result ec_scenarios_read(const char *file, const char *folder, const ec_given_options *given, ec_entries *entries, ec_error *err);

#endif
