// The motions of a case: finite elements in time, histories and rows of the models.
#pragma once

#include "comparisons/models/motion_recorder.h"
#include "comparisons/run/part_run.h"

namespace springproof {

/// Finite elements in time: PartRun::in_time, their run and their history.
void run_motion_reference(PartRun& run);

/// What a model is compared with at rest: nothing where its motion is compared with finite elements in time, of which
/// the last instant is no equilibrium.
const Reference* reference_at_rest(const PartRun& run, std::size_t lattice, const std::string& model);

/// The history of a motion; its frames become those of the first lattice's pictures, and a series of VTU files.
void add_motion(PartRun& run, std::size_t lattice, const std::string& model, Field field, MotionRecord motion);

/// What is measured in time of one model, and its distance from the reference.
void add_motion_rows(PartRun& run, const Row& blank, const HistoryRecord& history);

}  // namespace springproof
