#pragma once

namespace planbench {

/// Sets the process's peak resident memory back to its present resident memory. Does nothing where
/// the kernel does not permit it (/proc/self/clear_refs); the peak then is that since the start of
/// the process.
void ResetPeakMemory();

/// Peak resident memory of the process since the last reset, MiB; 0 where the system does not tell.
double PeakMemoryMb();

}  // namespace planbench
