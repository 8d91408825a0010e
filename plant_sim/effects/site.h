// Places where an effect can act. An effect has, for each site in its kSites, the member function
// named here, its main site first; a plant calls those of every active effect where its equations
// have that place, and lists in its own kSites which places it has. An effect fits a plant that has
// all of its sites.
//
//   command       S command_V(p, memory, u_V)                once per step, may remember
//   amplifier     S amplified_V(p, u_V)                      command that is followed
//   drive         S drive_V(p, memory, u_V)                  command after a motor's drive
//   set_speed     S set_mps(p, memory, asked_mps, moving_mps) speed that a servo's loop is given
//   lag           S inertia_ratio(p)                         coefficient of x'' over tau^2
//   spool         S spool_limit_mps(p)                       bound of the spool's speed
//   opening       S opening_m(p, x_m, gain_m_per_V)          valve opening from spool position
//   lap           S underlap_m(p, gain_m_per_V)              opening of every edge at null
//   edge          S edge_m(p, ahead_m, gain_m_per_V)         opening of an edge, its land so far
//                                                            ahead; negative: it covers the edge
//   supply        S supply_Pa(p, supply_Pa, port_Pa, flow)   pressure ahead of the open orifice;
//                                                            flow: its m3/s per sqrt(Pa)
//   flow          S flow_m3ps(p, flow_m3ps)                  of one orifice
//   leakage       Leak<S> leak(p, in_Pa, out_Pa)             what leaves either chamber
//   bulk_modulus  S bulk_modulus_Pa(p, modulus_Pa, at_Pa)    of the oil in one chamber
//   inertia       S added_mass_kg(p)                         mass that moves with the rod
//   force         S resisting_N(p, y_m, v_mps)               a force against extension
//   dry_friction  S friction_N(p, memory, DryContact)        sees the other forces: may hold them
//                 ContactLevels<S> levels(p, most_arrest_kg_per_s)  by which steps are divided
//   sensor        S reading_m(p, memory, y_m)                what the position sensor shows
//   coupling      S coupled_ratio(p)                         share of the mass behind a spring,
//                 S coupling_rate_per_s(p)                   its resonance, rad/s,
//                 S sensor_place(p)                          place of the sensor, 0 to 1 behind it,
//                 S pull_mps2(p, offset)                     and what the spring pulls; the plant
//                 CouplingOffset<S> Memory::offset           integrates it (coupled_step.h)
//
// Effects of one site act in the order of the table. An effect too fast for the integration step
// declares its slopes, and shorter steps are taken: `S slope_N_s_per_m(p, v_mps)` dF/dv, at the
// highest speed within the step, of a dry friction at the lowest, with that of the shortest part of
// a step, `S slope_N_s_per_m(p, least_mps, most_arrest_kg_per_s)`,
// `S stiffness_N_per_m(p)` the most that F changes with y, `S conductance_m3ps_per_Pa(p)`, and of a
// dry friction `S turn_parts(p, memory, TurningPart)`, into how many parts it asks for a step to be
// divided within which the motion may turn.
//
// An effect with memory has a struct Memory, owned by the plant, and may have
// `void accept(p, memory, travel_m, v_mps)`, called once per accepted integration step,
// `void Memory::prepare(step_s)`, called outside of steps, `void Memory::reset()`, and
// `void Memory::visit(v)`, which calls v(name, value) for each state integrated with the plant's.
// A new site is a line here, a call in EffectSet and a place in a plant.
#pragma once

namespace plant_sim::effects {

enum class Site : unsigned {
  command,
  amplifier,
  drive,
  set_speed,
  lag,
  spool,
  opening,
  lap,
  edge,
  supply,
  flow,
  leakage,
  bulk_modulus,
  inertia,
  force,
  dry_friction,
  sensor,
  coupling
};

inline const char* site_name(Site site) {
  constexpr const char* kNames[] = {
      "command",      "amplifier", "drive", "set_speed",    "lag",    "spool",
      "opening",      "lap",       "edge",  "supply",       "flow",   "leakage",
      "bulk_modulus", "inertia",   "force", "dry_friction", "sensor", "coupling"};
  return kNames[static_cast<unsigned>(site)];
}

template <class Sites>
constexpr bool has_site(const Sites& sites, Site wanted) {
  for (const Site site : sites) {
    if (site == wanted) return true;
  }
  return false;
}

/// True when every site of the effect is among the plant's.
template <class Effect, class Plant>
constexpr bool fits() {
  for (const Site site : Effect::kSites) {
    if (!has_site(Plant::kSites, site)) return false;
  }
  return true;
}

/// State of the moving part that a dry friction acts on, at one instant of an integration step.
template <class S>
struct DryContact {
  S v_mps;
  S travel_m;  ///< since the last accepted step
  S drive_N;   ///< sum of all other forces on the moving part, positive extends
  /// Mass over the part of a step that is integrated at once: the force per speed that stops it
  /// within one.
  S arrest_kg_per_s;
};

/// Forces of dry friction that decide how a step is divided; 0 where it has no such contact.
template <class S>
struct ContactLevels {
  S holding_N = 0.0;       ///< a rigid contact holds so much at rest, whichever way it is pushed
  S braking_N = 0.0;       ///< a rigid contact brakes with no more
  S gradual_N = 0.0;       ///< a contact that turns its sign gradually rubs with no more
  S spring_N_per_m = 0.0;  ///< a contact yields so before it slides
};

/// A step within which a dry friction may turn.
template <class S>
struct TurningPart {
  S v_mps;   ///< at its beginning
  S free_N;  ///< sum of all other forces on the moving part, positive extends
  S inverse_mass_per_kg;
  S step_s;
};

/// A mass on a spring, ahead of the moving part that carries it.
template <class S>
struct CouplingOffset {
  S offset_m = 0.0;
  S offset_mps = 0.0;
};

/// Flow that leaves the chambers other than through the valve.
template <class S>
struct Leak {
  S in_m3ps = 0.0;   ///< flow out of the chamber that extends
  S out_m3ps = 0.0;  ///< flow out of the chamber that retracts
};

}  // namespace plant_sim::effects
