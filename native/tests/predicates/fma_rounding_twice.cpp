// SPDX-License-Identifier: GPL-3.0-or-later
// Replaces the C library's fma in this program by one that rounds twice, as some platforms' does: exact signs that use
// it are wrong here as they are there.

extern "C" double fma(double x, double y, double z);

extern "C" double fma(double x, double y, double z) { return x * y + z; }
