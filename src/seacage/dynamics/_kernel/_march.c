/* The cage in time: LANES cases side by side, in single precision.
 *
 * The definition of every force is in _loads.py and _motion.py of _physics; this file computes
 * the same numbers, fast. Arrays of nodes are [node][axis][lane], of parts [part][lane], so that the
 * innermost loop always runs over lanes, which never see each other. Positions carry a second
 * float with what rounding cut off: without it a slow creep of the net would stall.
 *
 * The water's motion changes slowly against the time step. It is computed at the nodes every
 * `refresh` seconds, for where they will be, and runs straight in between; so do the
 * coefficients that depend on the Reynolds number and the share of a panel that is wet, which
 * are held.
 */
#include "_layout.h"
#include <math.h>
#include <stdint.h>
#include <string.h>

#define LANES 16 /* one vector of AVX-512, two of AVX2; _march_inputs.py asks seacage_march_lanes() */
#define EACH_LANE _Pragma("omp simd") for (int k = 0; k < LANES; k++)

typedef float lane[LANES];
typedef lane vec[3];
typedef double wide[LANES];

/* What the water loads: `loads` has three rows, of axes, for each. */
enum { NETTING, COLLAR, TUBE, ROPES, PUSH, BODIES }; /* PUSH: of the waves' acceleration */
enum { SCREENS = 0, TWINES = 1 }; /* kinds of law of the netting */

typedef struct {
    int32_t nodes, bars, bends, panels, cylinders, floats, springs, grounds, lines;
    int32_t buoys; /* lines at floats, not bars: the last ones */
    int32_t twines, slenders;
    int32_t cage_nodes; /* the first ones; PUSH is on them */
    const int32_t *bar_ends, *bend_nodes, *panel_corners, *cylinder_ends, *float_nodes,
        *spring_nodes, *ground_nodes, *line_bars, *line_floats, *slender_nodes;
    const int32_t *cylinder_body; /* of BODIES */
    const int32_t *twine_bars;    /* of the netting */
    const int32_t *anchor_bars;   /* [line] the bar that ends at its anchor, or -1 */
    const float *weight, *mass, *water_mass, *place;
    const float *chord; /* [node][2] horizontal, over which a node's waves are averaged [m] */
    const float *slender_tangent, *slender_mass; /* [slender][axis]; added mass not there along it */
    const float *bar_length, *bar_rate, *bar_damping, *bar_least; /* 0 or -infinity */
    const float *bend_stiffness, *bend_plane, *bend_turn;
    const float *panel_share, *panel_outline, *panel_mass;
    const float *cylinder_drag, *cylinder_skin; /* 1/4 rho Cd D, for each end */
    const float *float_stiffness, *float_draft, *float_height;
    const float *spring_place, *spring_stiffness, *spring_preload, *spring_damping;
    const float *ground_stiffness;
    const float *cylinder_series; /* [8] of the twine's drag in powers of log2 Re - its middle */
    float ground_level;
} body;

typedef struct {
    int32_t kind;
    const float *law;         /* [panel][3][lane]: at `refresh_panels` and `add_twines` */
    const float *drag_factor; /* [panel][lane] on drag and lift */
    const float *wake;        /* [panel][lane] share of the current left */
    const float *all; /* [6][lane]: SCREENS: C_D along the flow, e, share of cos and of cos3, factor
                         on lift, 1 where the Reynolds number counts; TWINES: Cn, Ct */
} netting;

/* Components stand in each lane in the order of their reach, the deepest first. */
typedef struct {
    int32_t components, levels;
    int32_t spread;                         /* whether a lane's components differ in direction */
    const int32_t *shallow;                 /* [component] whether one of its lanes feels the bed */
    const double *turns, *turns_per_second; /* [component][lane] phase, frequency */
    const float *number;                    /* [component][lane] wave number [turns/m] */
    const float *toward_x, *toward_y;       /* [component][lane], or [lane] of long crests */
    const float *amplitude, *speed;         /* [component][lane] of the surface and below [m, m/s] */
    const float *reach;                     /* [component][lane] z where it is no longer felt [m] */
    const float *floor, *bounce;            /* of finite depth: 1/(1-e^-2kh), e^-2kh of it */
    const float *level_z;                   /* [level], downwards */
    const float *current;                        /* [level][2][lane] */
    float depth;
} sea;

typedef struct {
    double time_step, ramp;
    int64_t first, refreshes; /* number of the first refresh of this call, and how many */
    int64_t count_from;       /* refreshes before it are not counted */
    int64_t sample_every;     /* refreshes between samples; 0 for none */
    int32_t steps;            /* of a refresh */
    int32_t hold;             /* steps through which the water's load is held */
} schedule;

typedef struct {
    vec *position, *rest, *velocity; /* rest: what rounding cut off */
    vec *water, *slope;              /* wave velocity at the last refresh, and its change [1/s] */
    vec *current, *relative, *force, *base;
    vec *held;                       /* base and the water's load, the latter as for no speed */
    lane *drag;                      /* how much a node's load falls with its speed [N s/m] */
    lane *elevation, *rise;          /* at the nodes: at the last refresh, and its change */
    vec *panel_current;
    lane *panel_factor;              /* drag factor times wet share */
    lane *panel_drag, *panel_lift;   /* coefficients that the speed changes */
    float *lost_at;                  /* [lane] time; negative while a case is well */
} state;

typedef struct {
    wide *node_sum, *node_square; /* [node*3] of displacements from `place` */
    lane *node_least, *node_most;
    wide *line_sum, *line_square; /* [line] */
    lane *line_least, *line_most;
    wide *load_sum, *load_square; /* [BODIES*3] */
    lane *load_least, *load_most;
    int64_t *counted, *sampled;
    wide *twine_sum; /* [twine], at every refresh, as what follows */
    lane *twine_most, *twine_slack;
    wide *anchor_sum; /* [3*line] pull on its anchor */
    lane *uplift_most; /* [line] of it upwards */
    float *positions, *elevations, *loads; /* [sample]..., or null; loads of the netting */
    float *tensions;                       /* [refresh][line], or null */
} record;

/* --- small functions, for vectors of lanes ---------------------------------------------- */

static inline float bits_float(int32_t i)
{
    float f;
    memcpy(&f, &i, sizeof f);
    return f;
}

static inline int32_t float_bits(float f)
{
    int32_t i;
    memcpy(&i, &f, sizeof i);
    return i;
}

/* 2^y for y <= 0; below -100 it is 2^-100. NaN gives 2^-100 too: no index is made of it. */
static inline float power_of_two(float y)
{
    y = y > -100.0f ? y : -100.0f;
    y = y < 100.0f ? y : 100.0f;
    const float whole = rintf(y), f = y - whole;
    const float p = 1.0f + f * (0.693147181f + f * (0.240226507f + f * (0.0555041087f
                    + f * (9.61812911e-3f + f * (1.33335581e-3f + f * 1.54035304e-4f)))));
    return p * bits_float(((int32_t)whole + 127) << 23);
}

/* log2 of a positive, normal float: exponent, and a series of atanh for the mantissa */
static inline float logarithm_2(float x)
{
    const int32_t bits = float_bits(x);
    const int32_t exponent = (bits - 0x3f3504f3) >> 23; /* mantissa from sqrt(1/2) to sqrt(2) */
    const float m = bits_float(bits - (exponent << 23));
    const float s = (m - 1.0f) / (m + 1.0f), ss = s * s;
    return (float)exponent
           + s * (2.88539008f + ss * (0.961796694f + ss * (0.577078016f + ss * 0.412198583f)));
}

/* cos and sin of an angle in turns, by half angles and Taylor's series */
#define COS_SIN(turns, c, s)                                                                     \
    do {                                                                                         \
        const float h_ = 3.14159265f * ((turns) - rintf(turns)), q_ = h_ * h_;                   \
        const float sh_ = h_ * (1.0f + q_ * (-1.66666667e-1f + q_ * (8.33333333e-3f              \
                          + q_ * (-1.98412698e-4f + q_ * (2.75573192e-6f                         \
                          + q_ * -2.50521084e-8f)))));                                           \
        const float ch_ = 1.0f + q_ * (-0.5f + q_ * (4.16666667e-2f + q_ * (-1.38888889e-3f      \
                          + q_ * (2.48015873e-5f + q_ * (-2.75573192e-7f                         \
                          + q_ * 2.08767570e-9f)))));                                            \
        (s) = 2.0f * sh_ * ch_;                                                                  \
        (c) = 1.0f - 2.0f * sh_ * sh_;                                                           \
    } while (0)

/* --- forces ------------------------------------------------------------------------------ */

/* Pull of a bar along it, damping included, and the unit vector. */
#define BAR(pull, i, j)                                                                          \
    const float dx = x[j][0][k] - x[i][0][k];                                                    \
    const float dy = x[j][1][k] - x[i][1][k];                                                    \
    const float dz = x[j][2][k] - x[i][2][k];                                                    \
    const float square = dx * dx + dy * dy + dz * dz;                                            \
    const float inverse = 1.0f / sqrtf(square > 1e-12f ? square : 1e-12f);                       \
    const float now = square * inverse;                                                          \
    const float apart = ((v[j][0][k] - v[i][0][k]) * dx + (v[j][1][k] - v[i][1][k]) * dy         \
                         + (v[j][2][k] - v[i][2][k]) * dz) * inverse;                            \
    const float stretch = rate * (now - length);                                                 \
    const float bears = stretch > least ? stretch + damping * apart : least;                     \
    const float pull = bears > least ? bears : least

static void add_bars(const body *b, const vec *restrict x, const vec *restrict v,
                     vec *restrict f)
{
    for (int n = 0; n < b->bars; n++) {
        const int i = b->bar_ends[2 * n], j = b->bar_ends[2 * n + 1];
        const float length = b->bar_length[n], rate = b->bar_rate[n];
        const float damping = b->bar_damping[n], least = b->bar_least[n];
        EACH_LANE {
            BAR(held, i, j);
            const float pull = held * inverse;
            f[i][0][k] += pull * dx;
            f[i][1][k] += pull * dy;
            f[i][2][k] += pull * dz;
            f[j][0][k] -= pull * dx;
            f[j][1][k] -= pull * dy;
            f[j][2][k] -= pull * dz;
        }
    }
}

static void bar_tension(const body *b, int n, const vec *restrict x, const vec *restrict v,
                        float *restrict tension)
{
    const int i = b->bar_ends[2 * n], j = b->bar_ends[2 * n + 1];
    const float length = b->bar_length[n], rate = b->bar_rate[n];
    const float damping = b->bar_damping[n], least = b->bar_least[n];
    EACH_LANE {
        BAR(held, i, j);
        tension[k] = held;
    }
}

static void add_bends(const body *b, const vec *restrict x, vec *restrict f)
{
    for (int n = 0; n < b->bends; n++) {
        const int *at = b->bend_nodes + 3 * n;
        const int i = at[0], j = at[1], m = at[2];
        const float stiffness = 4.0f * b->bend_stiffness[n];
        const float plane = b->bend_plane[n], cut = b->bend_turn[n];
        EACH_LANE {
            float p[3], q[3], pp = 1e-12f, qq = 1e-12f, c = 0.0f;
            for (int a = 0; a < 3; a++) {
                p[a] = x[j][a][k] - x[i][a][k];
                q[a] = x[m][a][k] - x[j][a][k];
                pp += p[a] * p[a];
                qq += q[a] * q[a];
                c += p[a] * q[a];
            }
            const float rp = 1.0f / sqrtf(pp), rq = 1.0f / sqrtf(qq);
            c *= rp * rq;
            const float open = 1.0f / (1.0f + c > 1e-3f ? 1.0f + c : 1e-3f);
            const float slope = stiffness * open * open;
            const float turn = 2.0f * (p[0] * q[1] - p[1] * q[0]) * rp * rq * open;
            const float moment = plane * (turn - cut) * open;
            const float q_up[3] = {2.0f * q[1] * rq, -2.0f * q[0] * rq, 0.0f};
            const float up_p[3] = {-2.0f * p[1] * rp, 2.0f * p[0] * rp, 0.0f};
            for (int a = 0; a < 3; a++) {
                const float t1 = p[a] * rp, t2 = q[a] * rq, along = turn * (t1 + t2);
                const float on_first = (slope * (t2 - c * t1) - moment * (q_up[a] - along)) * rp;
                const float on_second = (slope * (t1 - c * t2) - moment * (up_p[a] - along)) * rq;
                f[i][a][k] -= on_first;
                f[j][a][k] += on_first - on_second;
                f[m][a][k] += on_second;
            }
        }
    }
}

/* A panel's diagonals, and the water's velocity past it: w at its corners and its current. */
#define DIAGONALS                                                                                \
    const float ax = x[n[2]][0][k] - x[n[0]][0][k], bx = x[n[3]][0][k] - x[n[1]][0][k];          \
    const float ay = x[n[2]][1][k] - x[n[0]][1][k], by = x[n[3]][1][k] - x[n[1]][1][k];          \
    const float az = x[n[2]][2][k] - x[n[0]][2][k], bz = x[n[3]][2][k] - x[n[1]][2][k]
#define PAST(a)                                                                                  \
    (carried[p][a][k] + share[0] * w[n[0]][a][k] + share[1] * w[n[1]][a][k]                      \
     + share[2] * w[n[2]][a][k] + share[3] * w[n[3]][a][k])

static void share_out(const int *n, const float *share, const lane *restrict load,
                      const float *restrict falls, vec *restrict f, lane *restrict drag,
                      lane *restrict total)
{
    for (int a = 0; a < 3; a++)
        EACH_LANE total[a][k] += load[a][k];
    for (int e = 0; e < 4; e++) {
        for (int a = 0; a < 3; a++)
            EACH_LANE f[n[e]][a][k] += share[e] * load[a][k];
        EACH_LANE drag[n[e]][k] += share[e] * falls[k];
    }
}

/* Screens: C_D = max(0, s (1 - cos) + b cos + h cos3), C_L = l sin2 (1 + e cos2), b and h one
 * number times fixed shares, on the area as cut: twine is not lost in folds. What is nearly
 * closed turns to cos = 1/2 without lift. `falls`: how the load changes with speed. C_D serves
 * most: more would act as mass that is not there. In fast water a light panel needs more, or holding its load
 * through `span` would be unstable: the steepest slope less what the panel's mass bears.
 */
static void add_screens(const body *b, const netting *net, const state *s,
                        const vec *restrict x, float span, lane *total)
{
    const vec *restrict w = (const vec *)s->relative, *restrict carried = (const vec *)s->panel_current;
    const lane *restrict all = (const lane *)net->all;
    for (int p = 0; p < b->panels; p++) {
        const int *n = b->panel_corners + 4 * p;
        const float *share = b->panel_share + 4 * p;
        const float *restrict facing = s->panel_drag[p], *restrict lifting = s->panel_lift[p];
        const float *restrict factor = s->panel_factor[p];
        const float borne = 2.0f * b->panel_mass[p] / span;
        const float pressure = 512.5f * b->panel_outline[p], folds = 10.0f / b->panel_outline[p];
        vec load;
        lane falls;
        EACH_LANE {
            DIAGONALS;
            float nx = 0.5f * (ay * bz - az * by);
            float ny = 0.5f * (az * bx - ax * bz);
            float nz = 0.5f * (ax * by - ay * bx);
            const float square = nx * nx + ny * ny + nz * nz;
            const float flat = 1.0f / sqrtf(square > 1e-20f ? square : 1e-20f);
            const float area = square * flat;
            const float ux = PAST(0), uy = PAST(1), uz = PAST(2);
            const float uu = ux * ux + uy * uy + uz * uz;
            const float slow = 1.0f / sqrtf(uu > 1e-20f ? uu : 1e-20f);
            float c = (nx * ux + ny * uy + nz * uz) * flat * slow;
            const float closed = area * folds < 1.0f ? 1.0f - area * folds : 0.0f;
            const float open = 1.0f - closed * closed;
            const float turn = c < 0.0f ? -flat * open : flat * open;
            c = c < 0.0f ? -c : c;
            const float along = open * (c < 1.0f ? c : 1.0f);
            c = along + 0.5f * closed * closed;
            const float cc = c * c;
            const float skin = factor[k] * all[0][k];
            float cd = skin * (1.0f - c)
                       + facing[k] * c * (all[2][k] + all[3][k] * (4.0f * cc - 3.0f));
            cd = cd > 0.0f ? cd : 0.0f;
            const float cl = 2.0f * c * lifting[k] * (1.0f + all[1][k] * (2.0f * cc - 1.0f));
            const float on_u = pressure * uu * slow * (cd - cl * along); /* times u, of length |u| */
            const float on_n = pressure * uu * cl * turn;
            load[0][k] = on_u * ux + on_n * nx;
            load[1][k] = on_u * uy + on_n * ny;
            load[2][k] = on_u * uz + on_n * nz;
            const float steep = 1.25f * (1.5f * (facing[k] - skin) + cd) - borne / (pressure * uu * slow + 1e-6f);
            falls[k] = pressure * uu * slow * (cd > steep ? cd : steep);
        }
        share_out(n, share, (const lane *)load, falls, s->held, s->drag, total);
    }
}

/* One family of twines along t, in flow u: cross-flow drag and skin friction, added up. */
#define FAMILY(tx, ty, tz)                                                                       \
    do {                                                                                         \
        const float square_ = (tx) * (tx) + (ty) * (ty) + (tz) * (tz);                           \
        const float tt_ = square_ > 1e-12f ? square_ : 1e-12f;                                   \
        const float along_ = (ux * (tx) + uy * (ty) + uz * (tz)) / tt_;                          \
        const float cx_ = ux - along_ * (tx), cy_ = uy - along_ * (ty), cz_ = uz - along_ * (tz);\
        const float speed_ = sqrtf(cx_ * cx_ + cy_ * cy_ + cz_ * cz_);                           \
        const float number_ = reynolds * speed_ > 30.0f ? reynolds * speed_ : 30.0f;             \
        const float cn_ = by_reynolds ? 1.1f + 4.0f / sqrtf(number_) : given;                    \
        const float across_ = weight * cn_ * speed_;                                             \
        const float rubbed_ = weight * skin * (along_ < 0.0f ? -along_ : along_) * along_        \
                              * sqrtf(tt_);                                                      \
        lx += across_ * cx_ + rubbed_ * (tx);                                                    \
        ly += across_ * cy_ + rubbed_ * (ty);                                                    \
        lz += across_ * cz_ + rubbed_ * (tz);                                                    \
        fall += across_;                                                                         \
    } while (0)

/* Twine by twine. A panel's law: 1/2 rho × diameter × twine length of a family, diameter /
 * viscosity, whether the twines run at 45 degrees to the panel's edges. For all: Cn, below zero
 * after Choo and Casarella; Ct. */
static void add_twines(const body *b, const netting *net, const state *s,
                       const vec *restrict x, lane *total)
{
    const vec *restrict w = (const vec *)s->relative, *restrict carried = (const vec *)s->panel_current;
    const lane *restrict all = (const lane *)net->all;
    for (int p = 0; p < b->panels; p++) {
        const int *n = b->panel_corners + 4 * p;
        const float *share = b->panel_share + 4 * p;
        const lane *restrict law = (const lane *)net->law + 3 * p;
        const float *restrict factor = s->panel_factor[p];
        vec load;
        lane falls;
        EACH_LANE {
            DIAGONALS;
            const float weight = factor[k] * law[0][k], reynolds = law[1][k];
            const float given = all[0][k], skin = all[1][k];
            const int by_reynolds = given < 0.0f;
            const float mix = 1.0f - law[2][k]; /* edges are half sums of diagonals */
            const float ux = PAST(0), uy = PAST(1), uz = PAST(2);
            float lx = 0.0f, ly = 0.0f, lz = 0.0f, fall = 0.0f;
            FAMILY(ax + mix * bx, ay + mix * by, az + mix * bz);
            FAMILY(bx - mix * ax, by - mix * ay, bz - mix * az);
            load[0][k] = lx;
            load[1][k] = ly;
            load[2][k] = lz;
            falls[k] = fall;
        }
        share_out(n, share, (const lane *)load, falls, s->held, s->drag, total);
    }
}

static void add_cylinders(const body *b, const state *s, const vec *restrict x, lane *loads)
{
    const vec *restrict w = (const vec *)s->relative, *restrict current = (const vec *)s->current;
    vec *restrict f = s->held;
    lane *restrict drag = s->drag;
    for (int n = 0; n < b->cylinders; n++) {
        const int i = b->cylinder_ends[2 * n], j = b->cylinder_ends[2 * n + 1];
        const float width = b->cylinder_drag[n], skin = b->cylinder_skin[n];
        lane *restrict load = loads + 3 * b->cylinder_body[n];
        EACH_LANE {
            const float tx = x[j][0][k] - x[i][0][k];
            const float ty = x[j][1][k] - x[i][1][k];
            const float tz = x[j][2][k] - x[i][2][k];
            const float ux = 0.5f * (w[i][0][k] + w[j][0][k] + current[i][0][k] + current[j][0][k]);
            const float uy = 0.5f * (w[i][1][k] + w[j][1][k] + current[i][1][k] + current[j][1][k]);
            const float uz = 0.5f * (w[i][2][k] + w[j][2][k] + current[i][2][k] + current[j][2][k]);
            const float square = tx * tx + ty * ty + tz * tz;
            const float tt = square > 1e-12f ? square : 1e-12f;
            const float along = (ux * tx + uy * ty + uz * tz) / tt;
            const float ax = ux - along * tx, ay = uy - along * ty, az = uz - along * tz;
            const float pressure = width * sqrtf(tt * (ax * ax + ay * ay + az * az));
            const float rubbed = skin * tt * (along < 0.0f ? -along : along) * along;
            const float fx = pressure * ax + rubbed * tx;
            const float fy = pressure * ay + rubbed * ty;
            const float fz = pressure * az + rubbed * tz;
            f[i][0][k] += fx;
            f[i][1][k] += fy;
            f[i][2][k] += fz;
            f[j][0][k] += fx;
            f[j][1][k] += fy;
            f[j][2][k] += fz;
            load[0][k] += 2.0f * fx; /* half at each end */
            load[1][k] += 2.0f * fy;
            load[2][k] += 2.0f * fz;
            drag[i][k] += 1.4f * pressure;
            drag[j][k] += 1.4f * pressure;
        }
    }
}

/* How deep a float lies: not above the water, and no deeper than its box. */
static inline float draft_of(float draft, float height)
{
    draft = draft > 0.0f ? draft : 0.0f;
    return draft < height ? draft : height;
}

static void add_supports(const body *b, const state *s, float since, const vec *restrict x,
                         const vec *restrict v)
{
    vec *restrict f = s->force;
    for (int n = 0; n < b->floats; n++) {
        const int i = b->float_nodes[n];
        const float still = b->float_draft[n], height = b->float_height[n];
        const float stiffness = b->float_stiffness[n];
        EACH_LANE {
            const float draft = still - x[i][2][k] + s->elevation[i][k] + since * s->rise[i][k];
            f[i][2][k] += stiffness * draft_of(draft, height);
        }
    }
    for (int n = 0; n < b->springs; n++) {
        const int i = b->spring_nodes[n];
        for (int a = 0; a < 3; a++) {
            const float place = b->spring_place[3 * n + a];
            const float stiffness = b->spring_stiffness[3 * n + a];
            const float preload = b->spring_preload[3 * n + a];
            const float damping = b->spring_damping[3 * n + a];
            EACH_LANE f[i][a][k] += preload - stiffness * (x[i][a][k] - place)
                                    - damping * v[i][a][k];
        }
    }
    for (int n = 0; n < b->grounds; n++) {
        const int i = b->ground_nodes[n];
        const float stiffness = b->ground_stiffness[n];
        /* what lies on the bed is held by it: a tenth of critical damping, in all directions */
        const float damping = 0.2f * sqrtf(stiffness * b->mass[i]);
        EACH_LANE {
            const float sunk = b->ground_level - x[i][2][k];
            const float held = sunk > 0.0f ? 1.0f : 0.0f;
            f[i][0][k] -= held * damping * v[i][0][k];
            f[i][1][k] -= held * damping * v[i][1][k];
            f[i][2][k] += held * (stiffness * sunk - damping * v[i][2][k]);
        }
    }
}

/* What the waves' acceleration does to the cage's own and added water. */
static void add_push(const body *b, const state *s, lane *restrict load)
{
    for (int i = 0; i < b->cage_nodes; i++)
        for (int a = 0; a < 3; a++) {
            const float weight = a == 2 ? b->weight[i] : 0.0f;
            EACH_LANE load[a][k] += s->base[i][a][k] - weight;
        }
}

/* Loads of the water into s->held, for where the nodes will be so many seconds ahead, in the
 * middle of the time they are held: held from its beginning, they would lag. s->force is free
 * to keep those places, and is left with what is held. loads: by body, but for PUSH. */
static void hold_loads(const body *b, const netting *net, const state *s, float ahead,
                       float span, lane *loads)
{
    const vec *restrict now = (const vec *)s->position, *restrict v = (const vec *)s->velocity;
    const vec *restrict base = (const vec *)s->base;
    vec *restrict x = s->force, *restrict held = s->held;
    lane *restrict drag = s->drag;
    for (int i = 0; i < b->nodes; i++) {
        for (int a = 0; a < 3; a++)
            EACH_LANE {
                x[i][a][k] = now[i][a][k] + ahead * v[i][a][k];
                held[i][a][k] = base[i][a][k];
            }
        EACH_LANE drag[i][k] = 0.0f;
    }
    for (int a = 0; a < 3 * BODIES; a++)
        EACH_LANE loads[a][k] = 0.0f;
    if (net->kind == TWINES)
        add_twines(b, net, s, (const vec *)x, loads + 3 * NETTING);
    else
        add_screens(b, net, s, (const vec *)x, span, loads + 3 * NETTING);
    add_cylinders(b, s, (const vec *)x, loads);
    for (int i = 0; i < b->nodes; i++)
        for (int a = 0; a < 3; a++)
            EACH_LANE {
                const float load = held[i][a][k] + drag[i][k] * v[i][a][k];
                held[i][a][k] = load;
                x[i][a][k] = load;
            }
}

/* What springs back, into s->force, on top of what is held: held, it would stir motion up. */
static void add_forces(const body *b, const state *s, float since)
{
    const vec *restrict x = (const vec *)s->position, *restrict v = (const vec *)s->velocity;
    add_bars(b, x, v, s->force);
    add_bends(b, x, s->force);
    add_supports(b, s, since, x, v);
}

/* --- water ------------------------------------------------------------------------------- */

/* Mean of a cosine over a chord that is so many turns long, over its value in the middle: the
 * series of sin(pi t)/(pi t). None beyond one turn: what is left would be a side lobe. */
static inline float mean_over(float turns)
{
    float q = turns * turns;
    q = q < 1.0f ? q : 1.0f;
    const float mean = 1.0f + q * (-1.64493407f + q * (0.811742426f + q * (-0.190751824f
                       + q * (0.0261478478f + q * (-2.34608103e-3f + q * (1.48428793e-4f
                       + q * -6.9758736e-6f))))));
    return mean > 0.0f ? mean : 0.0f;
}

/* Surface and wave velocity at a place, Wheeler's stretching; `ahead`: phases at that time. Each
 * component counts with its mean over the `chord`, and only above its reach but where the
 * `whole` surface is needed. Called with constants for spread, averaged and whole. */
static inline __attribute__((always_inline)) void wave_sums(
    const sea *w, const int spread, const int averaged, const int whole,
    const lane *restrict ahead, float ramp, const lane *restrict at, const float *restrict chord,
    float *restrict elevation, lane *restrict u)
{
    lane cosine[w->components + 1], sine[w->components + 1], height, along, across;
    const float *restrict x = w->toward_x, *restrict y = w->toward_y;
    EACH_LANE elevation[k] = 0.0f;
    if (!spread)
        EACH_LANE {
            along[k] = at[0][k] * x[k] + at[1][k] * y[k];
            across[k] = chord[0] * x[k] + chord[1] * y[k];
        }
    int felt = 0;
    for (; felt < w->components; felt++) {
        const int c = felt;
        const float *restrict number = w->number + LANES * c, *restrict reach = w->reach + LANES * c;
        const float *restrict amplitude = w->amplitude + LANES * c;
        if (!whole) {
            int reaches = 0;
            _Pragma("omp simd reduction(|:reaches)") for (int k = 0; k < LANES; k++)
                reaches |= at[2][k] > reach[k];
            if (!reaches)
                break;
        }
        if (spread) {
            x = w->toward_x + LANES * c;
            y = w->toward_y + LANES * c;
            EACH_LANE {
                along[k] = at[0][k] * x[k] + at[1][k] * y[k];
                across[k] = chord[0] * x[k] + chord[1] * y[k];
            }
        }
        EACH_LANE {
            float cos_, sin_, share = 1.0f;
            COS_SIN(ahead[c][k] + number[k] * along[k], cos_, sin_);
            if (averaged)
                share = mean_over(number[k] * across[k]);
            if (!whole)
                share = at[2][k] > reach[k] ? share : 0.0f;
            cosine[c][k] = share * cos_;
            sine[c][k] = share * sin_;
            elevation[k] += amplitude[k] * cosine[c][k];
        }
    }
    const float depth = w->depth;
    lane flat_x, flat_y;
    EACH_LANE {
        elevation[k] *= ramp;
        float z = (at[2][k] - elevation[k]) * depth / (depth + elevation[k]);
        z = z < 0.0f ? z : 0.0f; /* a node above the surface meets the water at the surface */
        height[k] = 9.06472028f * (z > -depth ? z : -depth); /* 2 pi log2 e, for turns and 2^ */
        flat_x[k] = flat_y[k] = u[2][k] = 0.0f;
    }
    for (int c = 0; c < felt; c++) {
        const float *restrict number = w->number + LANES * c, *restrict speed = w->speed + LANES * c;
        const float *restrict floor = w->floor + LANES * c, *restrict bounce = w->bounce + LANES * c;
        const int shallow = w->shallow[c];
        if (spread) {
            x = w->toward_x + LANES * c;
            y = w->toward_y + LANES * c;
        }
        EACH_LANE {
            float direct = power_of_two(number[k] * height[k]), back = 0.0f;
            if (shallow) {
                back = bounce[k] / direct;
                direct *= floor[k];
            }
            const float flat = speed[k] * ((direct + back) * cosine[c][k]);
            u[2][k] += speed[k] * ((direct - back) * sine[c][k]);
            if (spread) {
                flat_x[k] += x[k] * flat;
                flat_y[k] += y[k] * flat;
            } else
                flat_x[k] += flat;
        }
    }
    EACH_LANE {
        u[0][k] = ramp * (spread ? flat_x[k] : flat_x[k] * x[k]);
        u[1][k] = ramp * (spread ? flat_y[k] : flat_x[k] * y[k]);
        u[2][k] *= ramp;
    }
}

static void wave_motion(const sea *w, const lane *restrict ahead, float ramp,
                        const lane *restrict at, const float *restrict chord, int whole,
                        float *restrict elevation, lane *restrict u)
{
    const int averaged = chord[0] != 0.0f || chord[1] != 0.0f;
#define SUMS(spread, averaged, whole)                                                            \
    wave_sums(w, spread, averaged, whole, ahead, ramp, at, chord, elevation, u)
    switch (4 * !!w->spread + 2 * averaged + !!whole) {
    case 0: SUMS(0, 0, 0); break;
    case 1: SUMS(0, 0, 1); break;
    case 2: SUMS(0, 1, 0); break;
    case 3: SUMS(0, 1, 1); break;
    case 4: SUMS(1, 0, 0); break;
    case 5: SUMS(1, 0, 1); break;
    case 6: SUMS(1, 1, 0); break;
    default: SUMS(1, 1, 1);
    }
#undef SUMS
}

static void current_at(const sea *w, const float *restrict z, lane *restrict u)
{
    const float *restrict first = w->current;
    EACH_LANE {
        u[0][k] = first[k];
        u[1][k] = first[LANES + k];
        u[2][k] = 0.0f;
    }
    for (int level = 1; level < w->levels; level++) {
        const float *restrict above = w->current + 2 * LANES * (level - 1);
        const float top = w->level_z[level - 1], span = top - w->level_z[level];
        EACH_LANE {
            float share = (top - z[k]) / span;
            share = share > 0.0f ? share : 0.0f;
            share = share < 1.0f ? share : 1.0f;
            u[0][k] += share * (above[2 * LANES + k] - above[k]);
            u[1][k] += share * (above[3 * LANES + k] - above[LANES + k]);
        }
    }
}

static double ramp_at(const schedule *t, double now)
{
    return now < t->ramp ? 0.5 - 0.5 * cos(3.14159265358979 * now / t->ramp) : 1.0;
}

/* Phases at a time, within a turn of zero: only then may they become floats. */
static void phases(const sea *w, double now, lane *restrict ahead)
{
    for (int c = 0; c < w->components; c++)
        EACH_LANE {
            const double turns = w->turns[LANES * c + k] - now * w->turns_per_second[LANES * c + k];
            ahead[c][k] = (float)(turns - rint(turns));
        }
}

/* Accelerating water pushes no added mass along a pipe. */
static void slip_water(const body *b, state *s)
{
    for (int n = 0; n < b->slenders; n++) {
        const int i = b->slender_nodes[n];
        const float *t = b->slender_tangent + 3 * n;
        const vec *restrict slope = (const vec *)s->slope + i;
        vec *restrict base = s->base + i;
        EACH_LANE {
            const float along = b->slender_mass[n] * (t[0] * (*slope)[0][k] + t[1] * (*slope)[1][k]
                                                      + t[2] * (*slope)[2][k]);
            for (int a = 0; a < 3; a++)
                (*base)[a][k] -= along * t[a];
        }
    }
}

/* The water at all nodes at the end of a refresh, for where they will be then. */
static void refresh_water(const body *b, const sea *w, const schedule *t, state *s, double end,
                          double interval)
{
    lane ahead[w->components + 1]; /* C has no arrays of none */
    phases(w, end, ahead);
    const float ramp = (float)ramp_at(t, end), span = (float)interval;
    int next_float = 0; /* in the order of nodes */
    for (int i = 0; i < b->nodes; i++) {
        vec at, u;
        lane elevation;
        for (int a = 0; a < 3; a++)
            EACH_LANE at[a][k] = s->position[i][a][k] + span * s->velocity[i][a][k];
        const int floats = next_float < b->floats && b->float_nodes[next_float] == i;
        next_float += floats;
        wave_motion(w, (const lane *)ahead, ramp, (const lane *)at, b->chord + 2 * i, floats,
                    elevation, u);
        current_at(w, at[2], s->current[i]);
        const float inertia = b->water_mass[i];
        for (int a = 0; a < 3; a++)
            EACH_LANE {
                /* the last refresh aimed at now: go on from where it arrived */
                s->water[i][a][k] += span * s->slope[i][a][k];
                s->slope[i][a][k] = (u[a][k] - s->water[i][a][k]) / span;
                s->base[i][a][k] = inertia * s->slope[i][a][k];
            }
        EACH_LANE s->base[i][2][k] += b->weight[i];
        EACH_LANE {
            s->elevation[i][k] += span * s->rise[i][k];
            s->rise[i][k] = (elevation[k] - s->elevation[i][k]) / span;
        }
    }
    slip_water(b, s);
}

/* Drag factor of a panel, times the share of it that is under the surface at its corners. */
static void wet_factor(const body *b, const netting *net, const state *s, int p,
                       float *restrict factor)
{
    const int *n = b->panel_corners + 4 * p;
    const float least = 0.4f * sqrtf(b->panel_outline[p]);
    const float *restrict whole = net->drag_factor + LANES * p;
    EACH_LANE {
        float out = 0.0f, span = 0.0f;
        for (int e = 0; e < 4; e++) {
            const float height = s->position[n[e]][2][k] - s->elevation[n[e]][k];
            out += height > 0.0f ? height : 0.0f;
            span += height > 0.0f ? height : -height;
        }
        factor[k] = whole[k] * (1.0f - out / (span > least ? span : least));
    }
}

/* What each panel carries of the current, and its coefficients at the present speed and height.
 * Law of a screen: drag of a facing panel, and lift. Of one with Reynolds number: that for 1 m/s,
 * C_D0 and C_N45 for each unit of the twine's drag coefficient. */
static void refresh_panels(const body *b, const netting *net, state *s)
{
    const vec *restrict carried = (const vec *)s->panel_current;
    for (int p = 0; p < b->panels; p++) {
        const int *n = b->panel_corners + 4 * p;
        const float *share = b->panel_share + 4 * p;
        const lane *restrict law = (const lane *)net->law + 3 * p;
        const float *restrict factor = s->panel_factor[p];
        const float *restrict wake = net->wake + LANES * p;
        wet_factor(b, net, s, p, s->panel_factor[p]);
        for (int a = 0; a < 3; a++)
            EACH_LANE {
                float sum = 0.0f;
                for (int e = 0; e < 4; e++)
                    sum += share[e] * s->current[n[e]][a][k];
                s->panel_current[p][a][k] = wake[k] * sum;
            }
        if (net->kind == TWINES)
            continue;
        const lane *restrict all = (const lane *)net->all;
        const vec *restrict w_ = (const vec *)s->relative;
        const float *restrict series = b->cylinder_series;
        EACH_LANE {
            float uu = 0.0f;
            for (int a = 0; a < 3; a++) {
                float past = carried[p][a][k];
                for (int e = 0; e < 4; e++)
                    past += share[e] * w_[n[e]][a][k];
                uu += past * past;
            }
            const int by_reynolds = all[5][k] > 0.0f;
            float number = by_reynolds ? law[0][k] * sqrtf(uu) : 512.0f;
            number = number > 32.0f ? number : 32.0f;
            number = number < 1e4f ? number : 1e4f;
            const float y = logarithm_2(number) - 9.0f;
            float c = series[7];
            for (int power = 6; power >= 0; power--)
                c = c * y + series[power];
            const float facing = c * law[1][k], normal = c * law[2][k];
            const float lift = 0.707106781f
                               * (0.5f * facing - 3.14159265f * normal / (8.0f + normal));
            s->panel_drag[p][k] = factor[k] * (by_reynolds ? facing : law[0][k]);
            s->panel_lift[p][k] = factor[k] * all[4][k] * (by_reynolds ? lift : law[1][k]);
        }
    }
}

/* --- steps ------------------------------------------------------------------------------- */

static void relative_flow(const body *b, state *s, float since)
{
    const vec *restrict water = (const vec *)s->water, *restrict slope = (const vec *)s->slope;
    const vec *restrict v = (const vec *)s->velocity;
    vec *restrict past = s->relative;
    for (int i = 0; i < b->nodes; i++)
        for (int a = 0; a < 3; a++)
            EACH_LANE past[i][a][k] = water[i][a][k] + since * slope[i][a][k] - v[i][a][k];
}

/* Along a pipe a node is lighter than `move` takes it to be. Its inertia m − a t tᵀ with drag d
 * taken at the new speed asks for F + t a / (m + h d − a) (t·F − d t·v) in place of F: the inverse
 * after Sherman and Morrison. */
static void lighten(const body *b, state *s, float step)
{
    for (int n = 0; n < b->slenders; n++) {
        const int i = b->slender_nodes[n];
        const float *t = b->slender_tangent + 3 * n;
        const float added = b->slender_mass[n], rest = b->mass[i] - added;
        const vec *restrict v = (const vec *)s->velocity + i;
        const float *restrict drag = s->drag[i];
        vec *restrict f = s->force + i;
        EACH_LANE {
            float along = 0.0f;
            for (int a = 0; a < 3; a++)
                along += t[a] * ((*f)[a][k] - drag[k] * (*v)[a][k]);
            along *= added / (rest + step * drag[k]);
            for (int a = 0; a < 3; a++)
                (*f)[a][k] += along * t[a];
        }
    }
}

/* Symplectic Euler; drag falls with the speed, and is taken at the new one. What is held begins
 * the next step's force. */
static void move(const body *b, state *s, float step)
{
    for (int i = 0; i < b->nodes; i++) {
        const float mass = b->mass[i];
        vec *restrict x = s->position + i, *restrict rest = s->rest + i, *restrict v = s->velocity + i;
        vec *restrict f = s->force + i;
        const vec *restrict held = (const vec *)s->held + i;
        const float *restrict drag = s->drag[i];
        lane share;
        EACH_LANE share[k] = 1.0f / (mass + step * drag[k]);
        for (int a = 0; a < 3; a++)
            EACH_LANE {
                const float faster = share[k] * (mass * (*v)[a][k] + step * (*f)[a][k]);
                const float old = (*x)[a][k], add = step * faster + (*rest)[a][k];
                const float now = old + add;
                (*v)[a][k] = faster;
                (*rest)[a][k] = add - (now - old);
                (*x)[a][k] = now;
                (*f)[a][k] = (*held)[a][k];
            }
    }
}

/* --- account ----------------------------------------------------------------------------- */

static void count(double value, double *restrict sum, double *restrict square)
{
    *sum += value;
    *square += value * value;
}

static void extremes(float value, float *restrict least, float *restrict most)
{
    *least = value < *least ? value : *least;
    *most = value > *most ? value : *most;
}

static void count_nodes(const body *b, const state *s, record *r)
{
    for (int i = 0; i < b->nodes; i++)
        for (int a = 0; a < 3; a++) {
            const int row = 3 * i + a;
            const float place = b->place[row];
            EACH_LANE {
                const float moved = s->position[i][a][k] - place;
                r->node_sum[row][k] += (double)moved;
                r->node_square[row][k] += (double)moved * (double)moved;
                extremes(s->position[i][a][k], &r->node_least[row][k], &r->node_most[row][k]);
            }
        }
}

static void count_loads(const body *b, const state *s, lane *restrict loads, record *r)
{
    add_push(b, s, loads + 3 * PUSH);
    for (int a = 0; a < 3 * BODIES; a++)
        EACH_LANE {
            count((double)loads[a][k], &r->load_sum[a][k], &r->load_square[a][k]);
            extremes(loads[a][k], &r->load_least[a][k], &r->load_most[a][k]);
        }
}

static void count_twines(const body *b, const state *s, record *r)
{
    const vec *x = (const vec *)s->position, *v = (const vec *)s->velocity;
    for (int n = 0; n < b->twines; n++) {
        lane tension;
        bar_tension(b, b->twine_bars[n], x, v, tension);
        EACH_LANE {
            r->twine_sum[n][k] += (double)tension[k];
            r->twine_most[n][k] = tension[k] > r->twine_most[n][k] ? tension[k] : r->twine_most[n][k];
            r->twine_slack[n][k] += tension[k] > 0.0f ? 0.0f : 1.0f;
        }
    }
}

/* An anchor line's last bar pulls its anchor, the bar's second end, along the bed and up. */
static void count_anchors(const body *b, const state *s, record *r)
{
    const vec *x = (const vec *)s->position, *v = (const vec *)s->velocity;
    for (int n = 0; n < b->lines; n++) {
        const int bar = b->anchor_bars[n];
        if (bar < 0)
            continue;
        const int i = b->bar_ends[2 * bar], j = b->bar_ends[2 * bar + 1];
        lane tension;
        bar_tension(b, bar, x, v, tension);
        EACH_LANE {
            const float dx = x[i][0][k] - x[j][0][k], dy = x[i][1][k] - x[j][1][k];
            const float dz = x[i][2][k] - x[j][2][k];
            const float pull = tension[k] / sqrtf(dx * dx + dy * dy + dz * dz + 1e-12f);
            r->anchor_sum[3 * n][k] += (double)(pull * dx);
            r->anchor_sum[3 * n + 1][k] += (double)(pull * dy);
            r->anchor_sum[3 * n + 2][k] += (double)(pull * dz);
            r->uplift_most[n][k] = pull * dz > r->uplift_most[n][k] ? pull * dz : r->uplift_most[n][k];
        }
    }
}

/* Tension of a buoy's chain: what the buoy lifts. */
static void buoy_tension(const body *b, int n, const state *s, float since, float *restrict tension)
{
    const int i = b->float_nodes[n];
    const float still = b->float_draft[n], height = b->float_height[n];
    const float stiffness = b->float_stiffness[n];
    EACH_LANE {
        const float surface = s->elevation[i][k] + since * s->rise[i][k];
        tension[k] = stiffness * draft_of(still - s->position[i][2][k] + surface, height);
    }
}

/* Where the present refresh keeps its tensions. */
static float *line_row(const body *b, const record *r)
{
    return r->tensions + (size_t)LANES * (size_t)b->lines * (size_t)*r->counted;
}

/* Lines are counted at every step, as a snap is shorter than a refresh, and sampled at every
 * refresh into `row` (else null), as what wears a line is shorter than most samples' distance. */
static void count_lines(const body *b, const state *s, float since, record *r, float *restrict row)
{
    const vec *x = (const vec *)s->position, *v = (const vec *)s->velocity;
    const int bars = b->lines - b->buoys;
    for (int n = 0; n < b->lines; n++) {
        lane tension;
        if (n < bars)
            bar_tension(b, b->line_bars[n], x, v, tension);
        else
            buoy_tension(b, b->line_floats[n - bars], s, since, tension);
        if (row)
            memcpy(row + LANES * n, tension, sizeof tension);
        EACH_LANE {
            count((double)tension[k], &r->line_sum[n][k], &r->line_square[n][k]);
            extremes(tension[k], &r->line_least[n][k], &r->line_most[n][k]);
        }
    }
}

static void sample(const body *b, const sea *w, const schedule *t, const state *s,
                   const lane *restrict loads, double now, record *r)
{
    const int64_t at = (*r->sampled)++;
    const size_t frame = sizeof(vec) * (size_t)b->nodes;
    memcpy((char *)r->positions + frame * (size_t)at, s->position, frame);
    memcpy(r->loads + 3 * LANES * at, loads + 3 * NETTING, sizeof(vec));
    lane ahead[w->components + 1];
    const float ramp = (float)ramp_at(t, now);
    float *restrict elevation = r->elevations + LANES * at;
    phases(w, now, ahead);
    EACH_LANE elevation[k] = 0.0f;
    for (int c = 0; c < w->components; c++)
        EACH_LANE {
            float cosine, sine;
            COS_SIN(ahead[c][k], cosine, sine);
            elevation[k] += ramp * w->amplitude[LANES * c + k] * cosine;
            (void)sine;
        }
}

/* A case whose nodes leave the finite numbers is given up where it is. */
static void give_up_lost(const body *b, state *s, double now)
{
    lane wild;
    EACH_LANE wild[k] = 0.0f;
    for (int i = 0; i < b->nodes; i++)
        for (int a = 0; a < 3; a++)
            EACH_LANE {
                const float v = s->velocity[i][a][k];
                wild[k] += v < 100.0f && v > -100.0f ? 0.0f : 1.0f; /* m/s; NaN counts */
            }
    for (int k = 0; k < LANES; k++) {
        if (wild[k] == 0.0f)
            continue;
        if (s->lost_at[k] < 0.0f)
            s->lost_at[k] = (float)now;
        for (int i = 0; i < b->nodes; i++)
            for (int a = 0; a < 3; a++) {
                s->position[i][a][k] = b->place[3 * i + a];
                s->velocity[i][a][k] = 0.0f;
                s->rest[i][a][k] = 0.0f;
            }
    }
}

int32_t seacage_march_lanes(void) { return LANES; }

/* All forces at a state, the water given at its nodes: for the tests. */
void seacage_march_forces(const body *b, const netting *net, state *s, float *loads)
{
    relative_flow(b, s, 0.0f);
    refresh_panels(b, net, s);
    hold_loads(b, net, s, 0.0f, 1.0f, (lane *)loads);
    add_push(b, s, (lane *)loads + 3 * PUSH);
    for (int i = 0; i < b->nodes; i++)
        for (int a = 0; a < 3; a++)
            EACH_LANE s->force[i][a][k] -= s->drag[i][k] * s->velocity[i][a][k];
    add_forces(b, s, 0.0f);
}

/* Surface and wave velocity at places, the waves' ramp done: for the tests. */
void seacage_march_water(const sea *w, const float *at, const float *chord, int32_t whole,
                         double now, float *elevation, float *u)
{
    lane ahead[w->components + 1];
    phases(w, now, ahead);
    wave_motion(w, (const lane *)ahead, 1.0f, (const lane *)at, chord, whole, elevation, (lane *)u);
}

/* March through some refreshes. Called again with `first` moved on, the numbers are the same
 * as of one longer call. Between calls netting and sea may change, and the body's parts. */
void seacage_march(const body *b, const netting *net, const sea *w, const schedule *t, state *s,
                   record *r)
{
    const float step = (float)t->time_step;
    const float middle = 0.5f * step * (float)(t->hold - 1);
    const double interval = t->time_step * t->steps;
    lane loads[3 * BODIES];
    for (int64_t n = t->first; n < t->first + t->refreshes; n++) {
        const double now = interval * (double)n;
        refresh_water(b, w, t, s, now + interval, interval);
        const int counts = n >= t->count_from;
        for (int32_t i = 0; i < t->steps; i++) {
            const float since = step * (float)i;
            if (i % t->hold == 0) {
                relative_flow(b, s, since + middle);
                if (i == 0)
                    refresh_panels(b, net, s);
                hold_loads(b, net, s, middle, step * (float)t->hold, loads);
            }
            add_forces(b, s, since);
            if (counts)
                count_lines(b, s, since, r, i == 0 && t->sample_every > 0 ? line_row(b, r) : 0);
            if (i == 0 && counts) {
                count_nodes(b, s, r);
                count_loads(b, s, loads, r);
                count_twines(b, s, r);
                count_anchors(b, s, r);
                if (t->sample_every > 0 && (n - t->count_from) % t->sample_every == 0)
                    sample(b, w, t, s, (const lane *)loads, now, r);
                (*r->counted)++;
            }
            lighten(b, s, step);
            move(b, s, step);
        }
        give_up_lost(b, s, now + interval);
    }
}

/* --- layouts, for Python to compare with its own ---------------------------------------- */

#define FIELD(name) LAYOUT_FIELD(body, name)
const layout_row seacage_layout_body[] = {
    FIELD(nodes), FIELD(bars), FIELD(bends), FIELD(panels), FIELD(cylinders), FIELD(floats),
    FIELD(springs), FIELD(grounds), FIELD(lines), FIELD(buoys), FIELD(twines),
    FIELD(slenders), FIELD(cage_nodes), FIELD(bar_ends), FIELD(bend_nodes), FIELD(panel_corners),
    FIELD(cylinder_ends), FIELD(float_nodes), FIELD(spring_nodes), FIELD(ground_nodes),
    FIELD(line_bars), FIELD(line_floats), FIELD(slender_nodes), FIELD(cylinder_body), FIELD(twine_bars),
    FIELD(anchor_bars), FIELD(weight), FIELD(mass), FIELD(water_mass), FIELD(place), FIELD(chord),
    FIELD(slender_tangent), FIELD(slender_mass), FIELD(bar_length), FIELD(bar_rate),
    FIELD(bar_damping), FIELD(bar_least), FIELD(bend_stiffness), FIELD(bend_plane),
    FIELD(bend_turn), FIELD(panel_share), FIELD(panel_outline), FIELD(panel_mass),
    FIELD(cylinder_drag), FIELD(cylinder_skin), FIELD(float_stiffness), FIELD(float_draft),
    FIELD(float_height),
    FIELD(spring_place), FIELD(spring_stiffness), FIELD(spring_preload), FIELD(spring_damping),
    FIELD(ground_stiffness), FIELD(cylinder_series), FIELD(ground_level), LAYOUT_END(body),
};
#undef FIELD

#define FIELD(name) LAYOUT_FIELD(netting, name)
const layout_row seacage_layout_netting[] = {
    FIELD(kind), FIELD(law), FIELD(drag_factor), FIELD(wake), FIELD(all), LAYOUT_END(netting),
};
#undef FIELD

#define FIELD(name) LAYOUT_FIELD(sea, name)
const layout_row seacage_layout_sea[] = {
    FIELD(components), FIELD(levels), FIELD(spread), FIELD(shallow), FIELD(turns),
    FIELD(turns_per_second), FIELD(number), FIELD(toward_x), FIELD(toward_y), FIELD(amplitude),
    FIELD(speed), FIELD(reach), FIELD(floor), FIELD(bounce), FIELD(level_z), FIELD(current), FIELD(depth), LAYOUT_END(sea),
};
#undef FIELD

#define FIELD(name) LAYOUT_FIELD(schedule, name)
const layout_row seacage_layout_schedule[] = {
    FIELD(time_step), FIELD(ramp), FIELD(first), FIELD(refreshes), FIELD(count_from),
    FIELD(sample_every), FIELD(steps), FIELD(hold), LAYOUT_END(schedule),
};
#undef FIELD

#define FIELD(name) LAYOUT_FIELD(state, name)
const layout_row seacage_layout_state[] = {
    FIELD(position), FIELD(rest), FIELD(velocity), FIELD(water), FIELD(slope), FIELD(current),
    FIELD(relative), FIELD(force), FIELD(base), FIELD(held), FIELD(drag), FIELD(elevation),
    FIELD(rise), FIELD(panel_current), FIELD(panel_factor), FIELD(panel_drag), FIELD(panel_lift), FIELD(lost_at),
    LAYOUT_END(state),
};
#undef FIELD

#define FIELD(name) LAYOUT_FIELD(record, name)
const layout_row seacage_layout_record[] = {
    FIELD(node_sum), FIELD(node_square), FIELD(node_least), FIELD(node_most), FIELD(line_sum),
    FIELD(line_square), FIELD(line_least), FIELD(line_most), FIELD(load_sum),
    FIELD(load_square), FIELD(load_least), FIELD(load_most), FIELD(counted), FIELD(sampled),
    FIELD(twine_sum), FIELD(twine_most), FIELD(twine_slack), FIELD(anchor_sum), FIELD(uplift_most),
    FIELD(positions), FIELD(elevations), FIELD(loads), FIELD(tensions), LAYOUT_END(record),
};
#undef FIELD
