/* The cage's forces, LANES cases side by side.
 *
 * The definition of every force is in _physics/_loads.py; this file computes the same numbers,
 * fast. Arrays of nodes are [node][axis][lane], of parts [part][lane]: the innermost loop always
 * runs over lanes that do not depend on each other, so a case's numbers are the same
 * whichever cases travel with it.
 */
#ifndef SEACAGE_FORCES
#define SEACAGE_FORCES

#include <math.h>
#include <stdint.h>
#include <string.h>

#define LANES 8 /* one vector of AVX-512, two of AVX2; _library.py asks seacage_lanes() */
#define EACH_LANE _Pragma("omp simd") for (int k = 0; k < LANES; k++)

typedef double vec[3][LANES];

#define LOST 1e12 /* no cage bears such a force [N]: the case has left the finite numbers */

typedef struct {
    int32_t nodes, bars, bends, panels, cylinders, floats, springs, grounds;
    const int32_t *bar_ends, *bend_nodes, *panel_corners, *cylinder_ends, *float_nodes,
        *spring_nodes, *ground_nodes;
    const double *weight;
    const double *bar_length, *bar_stiffness, *bar_least; /* least tension: 0 or -infinity */
    const double *bend_stiffness, *bend_plane, *bend_turn;
    const double *panel_share, *panel_outline;
    const double *cylinder_width;
    const double *float_stiffness, *float_draft, *float_height;
    const double *spring_place, *spring_stiffness, *spring_preload;
    const double *ground_stiffness;
    double ground_level;
} assembly;

typedef struct {
    const double *direction; /* [panel][3][lane] */
    const double *panel;     /* [panel][6][lane]: pressure, a, b, h, l, e of SteadyFlow */
    const double *pipe_direction; /* [cylinder][3][lane] */
    const double *pipe_pressure;  /* [cylinder][lane] */
} flow;

/* Bars of spring rate `rate`, loaded with `carried`: carried + rate (stretch − carried/k).
 * With rate = k this is Hooke's law; `tension` keeps what each bar bears. */
static void add_bars(const assembly *s, const double *bar_rate, const double *restrict carried,
                     double *restrict tension, const vec *restrict x, vec *restrict f)
{
    for (int b = 0; b < s->bars; b++) {
        const int i = s->bar_ends[2 * b], j = s->bar_ends[2 * b + 1];
        const double length = s->bar_length[b], least = s->bar_least[b], rate = bar_rate[b];
        const double give = length / s->bar_stiffness[b];
        EACH_LANE {
            const double dx = x[j][0][k] - x[i][0][k];
            const double dy = x[j][1][k] - x[i][1][k];
            const double dz = x[j][2][k] - x[i][2][k];
            const double now = sqrt(dx * dx + dy * dy + dz * dz);
            const double borne = carried[b * LANES + k];
            const double bears = borne + rate * (now - length - give * borne);
            const double held = bears > least ? bears : least;
            const double pull = held / now;
            tension[b * LANES + k] = held;
            f[i][0][k] += pull * dx;
            f[i][1][k] += pull * dy;
            f[i][2][k] += pull * dz;
            f[j][0][k] -= pull * dx;
            f[j][1][k] -= pull * dy;
            f[j][2][k] -= pull * dz;
        }
    }
}

static void add_bends(const assembly *s, const vec *restrict x, vec *restrict f)
{
    for (int b = 0; b < s->bends; b++) {
        const int *n = s->bend_nodes + 3 * b;
        const int i = n[0], j = n[1], m = n[2];
        const double stiffness = 4.0 * s->bend_stiffness[b];
        const double plane = s->bend_plane[b], cut = s->bend_turn[b];
        EACH_LANE {
            double p[3], q[3], pp = 0.0, qq = 0.0, c = 0.0;
            for (int a = 0; a < 3; a++) {
                p[a] = x[j][a][k] - x[i][a][k];
                q[a] = x[m][a][k] - x[j][a][k];
                pp += p[a] * p[a];
                qq += q[a] * q[a];
                c += p[a] * q[a];
            }
            const double rp = 1.0 / sqrt(pp), rq = 1.0 / sqrt(qq);
            c *= rp * rq;
            const double open = 1.0 / (1.0 + c), slope = stiffness * open * open;
            const double turn = 2.0 * (p[0] * q[1] - p[1] * q[0]) * rp * rq * open;
            const double moment = plane * (turn - cut) * open;
            const double q_up[3] = {2.0 * q[1] * rq, -2.0 * q[0] * rq, 0.0};
            const double up_p[3] = {-2.0 * p[1] * rp, 2.0 * p[0] * rp, 0.0};
            for (int a = 0; a < 3; a++) {
                const double t1 = p[a] * rp, t2 = q[a] * rq, along = turn * (t1 + t2);
                const double on_first = (slope * (t2 - c * t1) - moment * (q_up[a] - along)) * rp;
                const double on_second = (slope * (t1 - c * t2) - moment * (up_p[a] - along)) * rq;
                f[i][a][k] -= on_first;
                f[j][a][k] += on_first - on_second;
                f[m][a][k] += on_second;
            }
        }
    }
}

/* Share of panel p that is under still water, by lane. */
static inline void wet_share(const assembly *s, int p, const vec *restrict x, double *restrict wet)
{
    const int *n = s->panel_corners + 4 * p;
    const double least = 0.4 * sqrt(s->panel_outline[p]);
    EACH_LANE {
        double out = 0.0, span = 0.0;
        for (int e = 0; e < 4; e++) {
            const double height = x[n[e]][2][k];
            out += height > 0.0 ? height : 0.0;
            span += fabs(height);
        }
        wet[k] = 1.0 - out / (span > least ? span : least);
    }
}

static void add_panels(const assembly *s, const flow *w, const vec *restrict x, vec *restrict f)
{
    for (int p = 0; p < s->panels; p++) {
        const double *restrict u = w->direction + 3 * LANES * p;
        const int *n = s->panel_corners + 4 * p;
        const double *share = s->panel_share + 4 * p;
        const double *restrict law = w->panel + 6 * LANES * p;
        const double outline = s->panel_outline[p], folds = 10.0 / outline;
        double load[3][LANES], wet[LANES];
        wet_share(s, p, x, wet);
        EACH_LANE {
            const double ax = x[n[2]][0][k] - x[n[0]][0][k], bx = x[n[3]][0][k] - x[n[1]][0][k];
            const double ay = x[n[2]][1][k] - x[n[0]][1][k], by = x[n[3]][1][k] - x[n[1]][1][k];
            const double az = x[n[2]][2][k] - x[n[0]][2][k], bz = x[n[3]][2][k] - x[n[1]][2][k];
            double nx = 0.5 * (ay * bz - az * by);
            double ny = 0.5 * (az * bx - ax * bz);
            double nz = 0.5 * (ax * by - ay * bx);
            const double area = sqrt(nx * nx + ny * ny + nz * nz);
            const double ux = u[k], uy = u[LANES + k], uz = u[2 * LANES + k];
            double c = nx * ux + ny * uy + nz * uz;
            const double closed = area * folds < 1.0 ? 1.0 - area * folds : 0.0;
            const double open = 1.0 - closed * closed;
            const double turn = (c < 0.0 ? -open : open) / (area > 1e-12 ? area : 1e-12);
            nx *= turn;
            ny *= turn;
            nz *= turn;
            c *= turn;
            c = c < open ? c : open;
            const double along = c;
            c += 0.5 * closed * closed;
            const double force = wet[k] * law[k] * outline;
            double drag = law[LANES + k] + law[2 * LANES + k] * c
                          + law[3 * LANES + k] * c * (4.0 * c * c - 3.0);
            drag = drag > 0.0 ? drag : 0.0;
            const double lift = 2.0 * c * law[4 * LANES + k]
                                * (1.0 + law[5 * LANES + k] * (2.0 * c * c - 1.0));
            const double on_u = force * (drag - lift * along), on_n = force * lift;
            load[0][k] = on_u * ux + on_n * nx;
            load[1][k] = on_u * uy + on_n * ny;
            load[2][k] = on_u * uz + on_n * nz;
        }
        for (int e = 0; e < 4; e++)
            for (int a = 0; a < 3; a++)
                EACH_LANE f[n[e]][a][k] += share[e] * load[a][k];
    }
}

static void add_cylinders(const assembly *s, const flow *w, const vec *restrict x, vec *restrict f)
{
    for (int b = 0; b < s->cylinders; b++) {
        const double *restrict u = w->pipe_direction + 3 * LANES * b;
        const double *restrict pressure = w->pipe_pressure + LANES * b;
        const int i = s->cylinder_ends[2 * b], j = s->cylinder_ends[2 * b + 1];
        const double width = 0.5 * s->cylinder_width[b];
        EACH_LANE {
            double t[3], v[3], tt = 0.0, ut = 0.0, vv = 0.0;
            for (int a = 0; a < 3; a++) {
                t[a] = x[j][a][k] - x[i][a][k];
                tt += t[a] * t[a];
                ut += t[a] * u[a * LANES + k];
            }
            for (int a = 0; a < 3; a++) {
                v[a] = u[a * LANES + k] - ut / tt * t[a];
                vv += v[a] * v[a];
            }
            const double load = pressure[k] * width * sqrt(tt) * sqrt(vv);
            for (int a = 0; a < 3; a++) {
                f[i][a][k] += load * v[a];
                f[j][a][k] += load * v[a];
            }
        }
    }
}

static void add_supports(const assembly *s, const vec *restrict x, vec *restrict f)
{
    for (int b = 0; b < s->floats; b++) {
        const int i = s->float_nodes[b];
        const double still = s->float_draft[b], height = s->float_height[b];
        const double stiffness = s->float_stiffness[b];
        EACH_LANE {
            double draft = still - x[i][2][k];
            draft = draft > 0.0 ? draft : 0.0;
            draft = draft < height ? draft : height;
            f[i][2][k] += stiffness * draft;
        }
    }
    for (int b = 0; b < s->springs; b++) {
        const int i = s->spring_nodes[b];
        for (int a = 0; a < 3; a++) {
            const double place = s->spring_place[3 * b + a];
            const double stiffness = s->spring_stiffness[3 * b + a];
            const double preload = s->spring_preload[3 * b + a];
            EACH_LANE f[i][a][k] += preload - stiffness * (x[i][a][k] - place);
        }
    }
    for (int b = 0; b < s->grounds; b++) {
        const int i = s->ground_nodes[b];
        const double stiffness = s->ground_stiffness[b], level = s->ground_level;
        EACH_LANE {
            const double sunk = level - x[i][2][k];
            f[i][2][k] += sunk > 0.0 ? stiffness * sunk : 0.0;
        }
    }
}

static void add_forces(const assembly *s, const flow *w, const double *bar_rate,
                       const double *carried, double *tension, const vec *restrict x,
                       vec *restrict f)
{
    for (int i = 0; i < s->nodes; i++)
        EACH_LANE {
            f[i][0][k] = 0.0;
            f[i][1][k] = 0.0;
            f[i][2][k] = s->weight[i];
        }
    add_bars(s, bar_rate, carried, tension, x, f);
    add_bends(s, x, f);
    add_panels(s, w, x, f);
    add_cylinders(s, w, x, f);
    add_supports(s, x, f);
}

/* Largest force on a free node, by lane. */
static void residual_of(const assembly *s, const double *inverse_mass, const vec *restrict f,
                        double *restrict residual)
{
    EACH_LANE residual[k] = 0.0;
    for (int i = 0; i < s->nodes; i++) {
        if (inverse_mass[i] == 0.0)
            continue;
        EACH_LANE {
            const double square = f[i][0][k] * f[i][0][k] + f[i][1][k] * f[i][1][k]
                                  + f[i][2][k] * f[i][2][k];
            residual[k] = residual[k] > square ? residual[k] : square;
        }
    }
    EACH_LANE residual[k] = sqrt(residual[k]);
}

#endif
