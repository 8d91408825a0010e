/* The actuator of Song (2002) under output injection, for the benchmark's peer only: classical
 * Runge-Kutta, plain C, no limits.
 *
 *   y' = v                                   m v' = A (Pi - Po) - d v
 *   Pi' = beta / (V0 + A y) (Qi - A v)       Po' = beta / (V0 + A (L - y)) (A v - Qo)
 *   xv'' = wv^2 (Kv u - xv) - 2 zeta wv xv'
 *   xv >= 0: Qi = G xv q(Ps - Pi), Qo = G xv q(Po);   xv < 0: Qi = G xv q(Pi), Qo = G xv q(Ps - Po)
 *   q(p) = sign(p) sqrt|p|,  G = Cd w sqrt(2/rho)
 *
 * p: mass, damping, beta, V0, Ps, Kv, wv, zeta. residual: measured less modelled, n numbers. */
#include <math.h>

static const double kArea = 6.33e-4, kStroke = 0.61;

static double root(double p) { return p < 0.0 ? -sqrt(-p) : sqrt(p); }

static void rate(const double* p, double orifice, double u, const double* x, double* r) {
  const double flow = orifice * x[4];
  const double in = x[4] >= 0.0 ? flow * root(p[4] - x[2]) : flow * root(x[2]);
  const double out = x[4] >= 0.0 ? flow * root(x[3]) : flow * root(p[4] - x[3]);
  const double swept = kArea * x[1];
  r[0] = x[1];
  r[1] = (kArea * (x[2] - x[3]) - p[1] * x[1]) / p[0];
  r[2] = p[2] / (p[3] + kArea * x[0]) * (in - swept);
  r[3] = p[2] / (p[3] + kArea * (kStroke - x[0])) * (swept - out);
  r[4] = x[5];
  r[5] = p[6] * p[6] * (p[5] * u - x[4]) - 2.0 * p[7] * p[6] * x[5];
}

/// The first `led` samples are led to the measured position at leading_per_s.
void residuals(const double* p, int n, double sample_s, int steps, double observer_per_s, int led,
               double leading_per_s, const double* u, const double* y, double* residual) {
  const double h = sample_s / steps;
  const double orifice = 0.60 * 2.07e-2 * sqrt(2.0 / 847.0);
  double x[6] = {y[0], 0.0, 0.5 * p[4], 0.5 * p[4], 0.0, 0.0};
  for (int k = 0; k < n; ++k) {
    residual[k] = y[k] - x[0];
    x[0] += (k < led ? leading_per_s : observer_per_s) * sample_s * residual[k];
    for (int s = 0; s < steps; ++s) {
      double a[6], b[6], c[6], d[6], z[6];
      rate(p, orifice, u[k], x, a);
      for (int i = 0; i < 6; ++i) z[i] = x[i] + 0.5 * h * a[i];
      rate(p, orifice, u[k], z, b);
      for (int i = 0; i < 6; ++i) z[i] = x[i] + 0.5 * h * b[i];
      rate(p, orifice, u[k], z, c);
      for (int i = 0; i < 6; ++i) z[i] = x[i] + h * c[i];
      rate(p, orifice, u[k], z, d);
      for (int i = 0; i < 6; ++i) x[i] += h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
    }
  }
}
