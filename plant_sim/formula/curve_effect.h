// A law that is known as a curve: a table instead of a formula. TOML:
//
//   [curve_effects.seal_drag]
//   site = "force"                      # as of a formula (formula_effect.h)
//   over = "v_mps"                      # a signal that the site can see (signals.h)
//   times = "y_m"                       # optional: a signal by which the curve is multiplied
//   x = [-0.1, -0.05, 0.0, 0.05, 0.1]   # ascending
//   f = [-90.0, -20.0, 0.0, 20.0, 90.0]
//
// f is the curve at x, in the site's unit (per unit of `times`).
//
// Between the points the curve is a cubic with a continuous slope,
//
//   f(x_i + t h) = f_i + t (g + t ((3 d - 2 g - e) + t (g + e - 2 d))),
//   d = f_i+1 - f_i,  g = h m_i,  e = h m_i+1
//
// where m_i is the slope at x_i of the parabola through it and its neighbours (at the ends, that of
// the last interval). Beyond the ends the curve is constant. It is added to what the site has
// without it. It becomes a formula whose parameters f1, f2, ... are the values at the points: it is
// simulated and fitted as other effects are; a value that is exactly 0 stays so in a fit. Source
// for the slopes: C. de Boor, A practical guide to splines (1978), chapter IV (Bessel's).
#pragma once

#include <string>

#include "plant_sim/formula/formula_effect.h"

namespace plant_sim::formula {

/// Derives formula and parameters of an effect from its table: sizes are those of the table's
/// values, either sign.
void derive_formula(FormulaEffect& curve);

/// Throws config::schema::ConfigError for a table that is no curve; `where` is the table in a file.
void check_points(const FormulaEffect& curve, const std::string& where);

}  // namespace plant_sim::formula
