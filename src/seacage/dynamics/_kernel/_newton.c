/* Newton's method for equilibria, LANES cases side by side.
 *
 * The definition is `nearer` in benchmarks/_newton.py; this file computes the same, fast. The
 * tangent is kept as 3 × 3 blocks in the rows of its own LU factors, at places that _sparsity.py
 * has worked out. As each case has a lane of its own there is no choice of pivots: a shift on the
 * diagonal keeps the elimination sound, and what it loses in accuracy the next iteration mends.
 */
#include "_forces.h"
#include "_layout.h"

#define HELD 1e15 /* stiffness that holds a node where it is [N/m] */

typedef double lane[LANES];
typedef vec block[3];

typedef struct {
    const int32_t *row, *diagonal; /* of each row, in order of elimination: its first block (and
                                      at the end the number of all), its diagonal one */
    const int32_t *column;         /* of each block */
    const int32_t *order;          /* which node each row is of */
    const int32_t *bars, *bends, *panels, *cylinders, *floats, *springs, *grounds; /* [part][i][j]:
                                      their blocks */
} pattern;

typedef struct {
    const double *free;      /* [node] 0 holds a node */
    const double *true_rate; /* [bar] EA / length */
    double tolerance, reach, least_barrier, least_shift, most_shift;
    int32_t iterations; /* of this call */
} balance;

typedef struct {
    vec *position;  /* [node] */
    double *tension; /* [bar][lane] */
    double *barrier, *shift, *moved, *sign, *iterations, *residual; /* [lane] */
} balancing;

typedef struct {
    vec *truth, *force, *step; /* [node]: forces of the true law, of the linear one, the answer */
    double *zero, *tension;    /* [bar][lane] */
    double *bar;               /* [bar][6][lane]: unit vector, rate, tension, what it lacks */
    block *blocks;             /* [block] */
    int32_t *place;            /* [2][node]: of the blocks of the two rows at hand */
} bench;

/* What the bars' linear law adds to the forces of the true one, and to the tangent. */
static void linearise_bars(const assembly *s, const pattern *p, const balance *r,
                           const balancing *b, bench *w)
{
    const vec *restrict x = b->position;
    lane floor;
    EACH_LANE floor[k] = b->moved[k] < r->reach / 30.0 ? sqrt(b->barrier[k]) : 0.0;
    for (int q = 0; q < s->bars; q++) {
        const int i = s->bar_ends[2 * q], j = s->bar_ends[2 * q + 1];
        const double length = s->bar_length[q], rate = r->true_rate[q];
        const double slackens = s->bar_least[q] == 0.0 ? 1.0 : 0.0;
        const int32_t *to = p->bars + 4 * q;
        double *restrict u = w->bar + 6 * LANES * q;
        const double *restrict tension = b->tension + LANES * q;
        lane axial, across, change;
        EACH_LANE {
            const double dx = x[j][0][k] - x[i][0][k];
            const double dy = x[j][1][k] - x[i][1][k];
            const double dz = x[j][2][k] - x[i][2][k];
            const double now = sqrt(dx * dx + dy * dy + dz * dz);
            const double hooke = rate * (now - length);
            const double raised = tension[k] > floor[k] ? tension[k] : floor[k];
            const double bears = slackens > 0.0 && hooke > 0.0 ? raised : tension[k];
            const double divisor = slackens > 0.0 ? bears : 1.0;
            const double push = slackens * b->barrier[k] / divisor;
            const double share = 1.0 / (1.0 + push / divisor);
            const double lacks = share * (hooke - bears + push);
            const double truth = slackens > 0.0 && hooke < 0.0 ? 0.0 : hooke;
            u[k] = dx / now;
            u[LANES + k] = dy / now;
            u[2 * LANES + k] = dz / now;
            u[3 * LANES + k] = share * rate;
            u[4 * LANES + k] = bears;
            u[5 * LANES + k] = lacks;
            change[k] = bears + lacks - truth;
            across[k] = bears / now;
            axial[k] = share * rate - across[k];
        }
        for (int a = 0; a < 3; a++)
            EACH_LANE {
                const double pull = change[k] * u[a * LANES + k];
                w->force[i][a][k] += pull;
                w->force[j][a][k] -= pull;
            }
        for (int a = 0; a < 3; a++)
            for (int c = 0; c < 3; c++)
                EACH_LANE {
                    const double entry = axial[k] * u[a * LANES + k] * u[c * LANES + k]
                                         + (a == c ? across[k] : 0.0);
                    w->blocks[to[0]][a][c][k] += entry;
                    w->blocks[to[3]][a][c][k] += entry;
                    w->blocks[to[1]][a][c][k] -= entry;
                    w->blocks[to[2]][a][c][k] -= entry;
                }
    }
}

/* How a joint's curvature about the vertical rises as each of its nodes moves. */
static void turn_slopes(const int32_t *n, const vec *restrict x, vec *restrict turned)
{
    EACH_LANE {
        double p[3], q[3], pp = 0.0, qq = 0.0, pq = 0.0;
        for (int a = 0; a < 3; a++) {
            p[a] = x[n[1]][a][k] - x[n[0]][a][k];
            q[a] = x[n[2]][a][k] - x[n[1]][a][k];
            pp += p[a] * p[a];
            qq += q[a] * q[a];
            pq += p[a] * q[a];
        }
        const double rp = 1.0 / sqrt(pp), rq = 1.0 / sqrt(qq);
        const double open = 1.0 / (1.0 + pq * rp * rq);
        const double turn = 2.0 * (p[0] * q[1] - p[1] * q[0]) * rp * rq * open;
        const double q_up[3] = {2.0 * q[1] * rq, -2.0 * q[0] * rq, 0.0};
        const double up_p[3] = {-2.0 * p[1] * rp, 2.0 * p[0] * rp, 0.0};
        for (int a = 0; a < 3; a++) {
            const double along = turn * (p[a] * rp + q[a] * rq);
            const double by_first = (q_up[a] - along) * open * rp;
            const double by_second = (up_p[a] - along) * open * rq;
            turned[0][a][k] = -by_first;
            turned[1][a][k] = by_first - by_second;
            turned[2][a][k] = by_second;
        }
    }
}

static void linearise_bends(const assembly *s, const pattern *p, const vec *restrict x, bench *w)
{
    static const double share[3] = {1.0, -2.0, 1.0};
    for (int q = 0; q < s->bends; q++) {
        const int i = s->bend_nodes[3 * q], m = s->bend_nodes[3 * q + 2];
        const double stiffness = 4.0 * s->bend_stiffness[q], plane = s->bend_plane[q];
        block part;
        vec turned[3];
        turn_slopes(s->bend_nodes + 3 * q, x, turned);
        EACH_LANE {
            const double x0 = x[m][0][k] - x[i][0][k];
            const double x1 = x[m][1][k] - x[i][1][k];
            const double x2 = x[m][2][k] - x[i][2][k];
            const double chord[3] = {x0, x1, x2};
            const double over = 1.0 / (x0 * x0 + x1 * x1 + x2 * x2);
            for (int a = 0; a < 3; a++)
                for (int c = 0; c < 3; c++)
                    part[a][c][k] = stiffness * over * ((a == c) - over * chord[a] * chord[c]);
        }
        for (int e = 0; e < 9; e++)
            for (int a = 0; a < 3; a++)
                for (int c = 0; c < 3; c++)
                    EACH_LANE w->blocks[p->bends[9 * q + e]][a][c][k] +=
                        share[e / 3] * share[e % 3] * part[a][c][k]
                        + plane * turned[e / 3][a][k] * turned[e % 3][c][k];
    }
}

/* How a panel's load q A ((C_D − L m·u) u + L m) turns with its diagonals, m its normal times
 * how open it is and A as cut; and the load itself, as of a panel all wet. */
static void panel_slopes(const assembly *s, const flow *f, int q, const vec *restrict x,
                         vec *restrict by_first, vec *restrict by_second, lane *restrict load)
{
    const int *n = s->panel_corners + 4 * q;
    const double *restrict law = f->panel + 6 * LANES * q;
    const double outline = s->panel_outline[q], folds = 10.0 / outline;
    lane wet;
    wet_share(s, q, x, wet);
    EACH_LANE {
        double r[3], t[3], v[3], u[3];
        for (int a = 0; a < 3; a++) {
            r[a] = x[n[2]][a][k] - x[n[0]][a][k];
            t[a] = x[n[3]][a][k] - x[n[1]][a][k];
            u[a] = f->direction[(3 * q + a) * LANES + k];
        }
        v[0] = 0.5 * (r[1] * t[2] - r[2] * t[1]);
        v[1] = 0.5 * (r[2] * t[0] - r[0] * t[2]);
        v[2] = 0.5 * (r[0] * t[1] - r[1] * t[0]);
        const double area = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        double c = v[0] * u[0] + v[1] * u[1] + v[2] * u[2];
        const double side = c < 0.0 ? -1.0 : 1.0;
        const double turn = side / (area > 1e-12 ? area : 1e-12);
        for (int a = 0; a < 3; a++)
            v[a] *= turn;
        const double straight = c * turn < 1.0 ? c * turn : 1.0;
        const double closed = area * folds < 1.0 ? 1.0 - area * folds : 0.0;
        const double open = 1.0 - closed * closed, opens = 2.0 * closed * folds;
        const double over = open / (area > 1e-12 ? area : 1e-12);
        const double along = open * straight;
        c = along + 0.5 * closed * closed;
        const double slope = law[2 * LANES + k], third = law[3 * LANES + k];
        const double twice = 2.0 * law[4 * LANES + k], second = law[5 * LANES + k];
        const double drag = law[LANES + k] + slope * c + third * c * (4.0 * c * c - 3.0);
        const double dragged = drag > 0.0 ? 1.0 : 0.0;
        const double lift = twice * c * (1.0 + second * (2.0 * c * c - 1.0));
        const double lift_c = twice * (1.0 + second * (6.0 * c * c - 1.0));
        const double on_u = dragged * drag - lift * along;
        const double on_u_c = dragged * (slope + third * (12.0 * c * c - 3.0)) - lift_c * along;
        const double whole = law[k] * outline, pressure = wet[k] * whole * side;
        for (int a = 0; a < 3; a++) {
            load[a][k] = whole * (on_u * u[a] + lift * open * v[a]);
            double m[3]; /* a row of the load's slope in the area vector */
            for (int e = 0; e < 3; e++) {
                const double turned = over * (u[e] - straight * v[e]); /* slope of m·u */
                const double facing = turned + opens * straight * v[e];
                const double of_c = facing - 0.5 * opens * v[e];
                const double of_m = over * ((a == e) - v[a] * v[e]) + opens * v[a] * v[e];
                m[e] = pressure * (u[a] * (on_u_c * of_c - lift * facing)
                                   + open * v[a] * lift_c * of_c + lift * of_m);
            }
            by_first[a][0][k] = -0.5 * (m[1] * t[2] - m[2] * t[1]);
            by_first[a][1][k] = -0.5 * (m[2] * t[0] - m[0] * t[2]);
            by_first[a][2][k] = -0.5 * (m[0] * t[1] - m[1] * t[0]);
            by_second[a][0][k] = 0.5 * (m[1] * r[2] - m[2] * r[1]);
            by_second[a][1][k] = 0.5 * (m[2] * r[0] - m[0] * r[2]);
            by_second[a][2][k] = 0.5 * (m[0] * r[1] - m[1] * r[0]);
        }
    }
}

/* How the wet share of a panel falls as each corner rises; 1 if it does in any lane. */
static int drying(const assembly *s, int q, const vec *restrict x, lane *restrict falls)
{
    const int *n = s->panel_corners + 4 * q;
    const double least = 0.4 * sqrt(s->panel_outline[q]);
    EACH_LANE {
        double out = 0.0, span = 0.0;
        for (int e = 0; e < 4; e++) {
            const double height = x[n[e]][2][k];
            out += height > 0.0 ? height : 0.0;
            span += fabs(height);
        }
        const double flat = span > least ? 0.0 : 1.0, whole = flat > 0.0 ? least : span;
        const double over = 1.0 / whole, share = (1.0 - flat) * out * over;
        for (int e = 0; e < 4; e++) {
            const double above = x[n[e]][2][k] > 0.0 ? 1.0 : 0.0;
            falls[e][k] = over * (above + share * (1.0 - 2.0 * above));
        }
    }
    int any = 0;
    for (int e = 0; e < 4; e++)
        for (int k = 0; k < LANES; k++)
            any |= falls[e][k] != 0.0;
    return any;
}

static void linearise_panels(const assembly *s, const flow *f, const pattern *p,
                             const vec *restrict x, bench *w)
{
    for (int q = 0; q < s->panels; q++) {
        block by_first, by_second;
        vec load;
        lane falls[4];
        panel_slopes(s, f, q, x, by_first, by_second, load);
        const int dries = drying(s, q, x, falls);
        for (int e = 0; e < 4; e++) {
            const int32_t *to = p->panels + 16 * q + 4 * e;
            const double share = s->panel_share[4 * q + e];
            for (int a = 0; a < 3; a++)
                for (int c = 0; c < 3; c++)
                    EACH_LANE {
                        const double one = share * by_first[a][c][k];
                        const double two = share * by_second[a][c][k];
                        w->blocks[to[0]][a][c][k] += one;
                        w->blocks[to[2]][a][c][k] -= one;
                        w->blocks[to[1]][a][c][k] += two;
                        w->blocks[to[3]][a][c][k] -= two;
                    }
            for (int g = 0; dries && g < 4; g++)
                for (int a = 0; a < 3; a++)
                    EACH_LANE w->blocks[to[g]][a][2][k] += share * falls[g][k] * load[a][k];
        }
    }
}

/* How a cylinder's drag turns with it; half of it falls on either end. */
static void linearise_cylinders(const assembly *s, const flow *f, const pattern *p,
                                const vec *restrict x, bench *w)
{
    for (int q = 0; q < s->cylinders; q++) {
        const double *restrict u = f->pipe_direction + 3 * LANES * q;
        const double *restrict pressure = f->pipe_pressure + LANES * q;
        const int i = s->cylinder_ends[2 * q], j = s->cylinder_ends[2 * q + 1];
        const double width = 0.5 * s->cylinder_width[q];
        const int32_t *to = p->cylinders + 4 * q;
        block turns;
        EACH_LANE {
            double t[3], v[3], tt = 0.0, ut = 0.0, vv = 0.0;
            for (int a = 0; a < 3; a++) {
                t[a] = x[j][a][k] - x[i][a][k];
                tt += t[a] * t[a];
            }
            const double over = 1.0 / sqrt(tt);
            for (int a = 0; a < 3; a++) {
                t[a] *= over;
                ut += t[a] * u[a * LANES + k];
            }
            for (int a = 0; a < 3; a++) {
                v[a] = u[a * LANES + k] - ut * t[a];
                vv += v[a] * v[a];
            }
            const double speed = sqrt(vv), load = pressure[k] * width;
            const double slow = speed > 1e-9 ? ut / speed : 0.0;
            for (int a = 0; a < 3; a++)
                for (int c = 0; c < 3; c++)
                    turns[a][c][k] = load * (speed * (v[a] * t[c] - t[a] * v[c])
                                             - slow * v[a] * v[c]
                                             - speed * ut * ((a == c) - t[a] * t[c]));
        }
        for (int a = 0; a < 3; a++)
            for (int c = 0; c < 3; c++)
                EACH_LANE {
                    w->blocks[to[0]][a][c][k] += turns[a][c][k];
                    w->blocks[to[1]][a][c][k] -= turns[a][c][k];
                    w->blocks[to[2]][a][c][k] += turns[a][c][k];
                    w->blocks[to[3]][a][c][k] -= turns[a][c][k];
                }
    }
}

static void linearise_supports(const assembly *s, const pattern *p, const vec *restrict x, bench *w)
{
    for (int q = 0; q < s->floats; q++) {
        const int i = s->float_nodes[q];
        const double still = s->float_draft[q], height = s->float_height[q];
        const double stiffness = s->float_stiffness[q];
        EACH_LANE {
            const double draft = still - x[i][2][k];
            w->blocks[p->floats[q]][2][2][k] += draft > 0.0 && draft < height ? stiffness : 0.0;
        }
    }
    for (int q = 0; q < s->springs; q++)
        for (int a = 0; a < 3; a++)
            EACH_LANE w->blocks[p->springs[q]][a][a][k] += s->spring_stiffness[3 * q + a];
    for (int q = 0; q < s->grounds; q++) {
        const int i = s->ground_nodes[q];
        const double stiffness = s->ground_stiffness[q], level = s->ground_level;
        EACH_LANE w->blocks[p->grounds[q]][2][2][k] += x[i][2][k] < level ? stiffness : 0.0;
    }
}

/* Forces, and the slope with which they fall as nodes move. */
static void linearise(const assembly *s, const flow *f, const pattern *p, const balance *r,
                      const balancing *b, bench *w)
{
    add_forces(s, f, r->true_rate, w->zero, w->tension, b->position, w->truth);
    memcpy(w->force, w->truth, s->nodes * sizeof(vec));
    memset(w->blocks, 0, p->row[s->nodes] * sizeof(block));
    linearise_bars(s, p, r, b, w);
    linearise_bends(s, p, b->position, w);
    linearise_panels(s, f, p, b->position, w);
    linearise_cylinders(s, f, p, b->position, w);
    linearise_supports(s, p, b->position, w);
    for (int i = 0; i < s->nodes; i++) {
        const double free = r->free[p->order[i]], held = free > 0.0 ? 0.0 : HELD;
        for (int a = 0; a < 3; a++)
            EACH_LANE {
                w->blocks[p->diagonal[i]][a][a][k] += b->shift[k] + held;
                w->force[p->order[i]][a][k] *= free;
            }
    }
}

/* The inverse of a block by its cofactors; its determinant's sign goes into the whole one's. */
static void invert(vec *restrict m, double *restrict sign)
{
    EACH_LANE {
        const double a = m[0][0][k], b = m[0][1][k], c = m[0][2][k];
        const double d = m[1][0][k], e = m[1][1][k], f = m[1][2][k];
        const double g = m[2][0][k], h = m[2][1][k], i = m[2][2][k];
        const double p = e * i - f * h, q = f * g - d * i, r = d * h - e * g;
        const double over = 1.0 / (a * p + b * q + c * r);
        sign[k] = over < 0.0 ? -sign[k] : sign[k];
        m[0][0][k] = p * over;
        m[0][1][k] = (c * h - b * i) * over;
        m[0][2][k] = (b * f - c * e) * over;
        m[1][0][k] = q * over;
        m[1][1][k] = (a * i - c * g) * over;
        m[1][2][k] = (c * d - a * f) * over;
        m[2][0][k] = r * over;
        m[2][1][k] = (b * g - a * h) * over;
        m[2][2][k] = (a * e - b * d) * over;
    }
}

/* a ← a b. */
static void multiply(vec *restrict a, const vec *restrict b)
{
    for (int i = 0; i < 3; i++)
        EACH_LANE {
            const double p = a[i][0][k], q = a[i][1][k], r = a[i][2][k];
            a[i][0][k] = p * b[0][0][k] + q * b[1][0][k] + r * b[2][0][k];
            a[i][1][k] = p * b[0][1][k] + q * b[1][1][k] + r * b[2][1][k];
            a[i][2][k] = p * b[0][2][k] + q * b[1][2][k] + r * b[2][2][k];
        }
}

/* c ← c − a b. */
static inline void take_product(vec *restrict c, const vec *restrict a, const vec *restrict b)
{
    for (int j = 0; j < 3; j++)
        EACH_LANE {
            const double p = b[0][j][k], q = b[1][j][k], r = b[2][j][k];
            c[0][j][k] -= a[0][0][k] * p + a[0][1][k] * q + a[0][2][k] * r;
            c[1][j][k] -= a[1][0][k] * p + a[1][1][k] * q + a[1][2][k] * r;
            c[2][j][k] -= a[2][0][k] * p + a[2][1][k] * q + a[2][2][k] * r;
        }
}

/* c ← c − a b for two rows that meet the same b, which is read once. */
static inline void take_products(vec *restrict c, const vec *restrict a, vec *restrict d,
                                 const vec *restrict e, const vec *restrict b)
{
    for (int j = 0; j < 3; j++)
        EACH_LANE {
            const double p = b[0][j][k], q = b[1][j][k], r = b[2][j][k];
            c[0][j][k] -= a[0][0][k] * p + a[0][1][k] * q + a[0][2][k] * r;
            c[1][j][k] -= a[1][0][k] * p + a[1][1][k] * q + a[1][2][k] * r;
            c[2][j][k] -= a[2][0][k] * p + a[2][1][k] * q + a[2][2][k] * r;
            d[0][j][k] -= e[0][0][k] * p + e[0][1][k] * q + e[0][2][k] * r;
            d[1][j][k] -= e[1][0][k] * p + e[1][1][k] * q + e[1][2][k] * r;
            d[2][j][k] -= e[2][0][k] * p + e[2][1][k] * q + e[2][2][k] * r;
        }
}

/* Take from a row what stands above its block e, which becomes one of the factor L. */
static void eliminate(const pattern *p, block *restrict blocks, const int32_t *restrict place, int e)
{
    const int32_t *restrict column = p->column;
    const int above = column[e], last = p->row[above + 1];
    block left; /* a copy, which the compiler may keep in registers */
    multiply(blocks[e], blocks[p->diagonal[above]]);
    memcpy(left, blocks[e], sizeof left);
    for (int g = p->diagonal[above] + 1; g < last; g++)
        take_product(blocks[place[column[g]]], left, blocks[g]);
}

/* The same for blocks of two rows in one column. */
static void eliminate_both(const pattern *p, block *restrict blocks, const int32_t *restrict place,
                           const int32_t *restrict next, int e, int f)
{
    const int32_t *restrict column = p->column;
    const int above = column[e], last = p->row[above + 1];
    block left, low;
    multiply(blocks[e], blocks[p->diagonal[above]]);
    multiply(blocks[f], blocks[p->diagonal[above]]);
    memcpy(left, blocks[e], sizeof left);
    memcpy(low, blocks[f], sizeof low);
    for (int g = p->diagonal[above] + 1; g < last; g++)
        take_products(blocks[place[column[g]]], left, blocks[next[column[g]]], low, blocks[g]);
}

/* LU in place, two rows at a time, as memory is what it waits for; diagonal blocks are left
 * inverted. */
static void factorise(const assembly *s, const pattern *p, bench *w, double *sign)
{
    int32_t *place = w->place, *next = w->place + s->nodes;
    EACH_LANE sign[k] = 1.0;
    for (int i = 0; i < s->nodes; i += 2) {
        const int pair = i + 1 < s->nodes;
        int e = p->row[i], f = pair ? p->row[i + 1] : 0;
        const int end = p->diagonal[i], low_end = pair ? p->diagonal[i + 1] : 0;
        for (int g = e; g < p->row[i + 1]; g++)
            place[p->column[g]] = g;
        for (int g = f; pair && g < p->row[i + 2]; g++)
            next[p->column[g]] = g;
        while (e < end || f < low_end) {
            if (e == end && p->column[f] >= i)
                break;
            if (f == low_end || (e < end && p->column[e] < p->column[f]))
                eliminate(p, w->blocks, place, e++);
            else if (e == end || p->column[f] < p->column[e])
                eliminate(p, w->blocks, next, f++);
            else
                eliminate_both(p, w->blocks, place, next, e++, f++);
        }
        invert(w->blocks[p->diagonal[i]], sign);
        if (f < low_end)
            eliminate(p, w->blocks, next, f);
        if (pair)
            invert(w->blocks[p->diagonal[i + 1]], sign);
    }
}

/* y ← y − a z. */
static void take_vector(lane *restrict y, const vec *restrict a, const lane *restrict z)
{
    for (int i = 0; i < 3; i++)
        EACH_LANE y[i][k] -= a[i][0][k] * z[0][k] + a[i][1][k] * z[1][k] + a[i][2][k] * z[2][k];
}

/* The step that the factors give for the linear law's forces. */
static void substitute(const assembly *s, const pattern *p, const balance *r, bench *w)
{
    for (int i = 0; i < s->nodes; i++) {
        lane *y = w->step[p->order[i]];
        memcpy(y, w->force[p->order[i]], sizeof(vec));
        for (int e = p->row[i]; e < p->diagonal[i]; e++)
            take_vector(y, w->blocks[e], w->step[p->order[p->column[e]]]);
    }
    for (int i = s->nodes - 1; i >= 0; i--) {
        const vec *d = w->blocks[p->diagonal[i]];
        const double free = r->free[p->order[i]];
        lane *y = w->step[p->order[i]];
        for (int e = p->diagonal[i] + 1; e < p->row[i + 1]; e++)
            take_vector(y, w->blocks[e], w->step[p->order[p->column[e]]]);
        EACH_LANE {
            const double a = free * y[0][k], b = free * y[1][k], c = free * y[2][k];
            y[0][k] = d[0][0][k] * a + d[0][1][k] * b + d[0][2][k] * c;
            y[1][k] = d[1][0][k] * a + d[1][1][k] * b + d[1][2][k] * c;
            y[2][k] = d[2][0][k] * a + d[2][1][k] * b + d[2][2][k] * c;
        }
    }
}

/* Go along the step by a share, that of lanes which are done being zero. */
static void advance(const assembly *s, balancing *b, const bench *w, const double *restrict share)
{
    for (int q = 0; q < s->bars; q++) {
        const int i = s->bar_ends[2 * q], j = s->bar_ends[2 * q + 1];
        const int slackens = s->bar_least[q] == 0.0;
        const double *restrict u = w->bar + 6 * LANES * q;
        double *restrict tension = b->tension + LANES * q;
        EACH_LANE {
            double stretch = 0.0;
            for (int a = 0; a < 3; a++)
                stretch += u[a * LANES + k] * (w->step[j][a][k] - w->step[i][a][k]);
            const double bears = u[4 * LANES + k], least = 0.05 * bears;
            const double next =
                bears + share[k] * (u[5 * LANES + k] + u[3 * LANES + k] * stretch);
            tension[k] = slackens && next < least ? least : next;
        }
    }
    for (int i = 0; i < s->nodes; i++)
        for (int a = 0; a < 3; a++)
            EACH_LANE b->position[i][a][k] += share[k] * w->step[i][a][k];
}

/* Longest step of a node along an axis, by lane. */
static void longest(const assembly *s, const vec *restrict step, double *restrict far)
{
    EACH_LANE far[k] = 0.0;
    for (int i = 0; i < s->nodes; i++)
        for (int a = 0; a < 3; a++)
            EACH_LANE {
                const double this = fabs(step[i][a][k]);
                far[k] = far[k] > this ? far[k] : this;
            }
}

/* Which lanes are not done, by the residuals that are known? */
static int open_lanes(const balance *r, const balancing *b, double *restrict open)
{
    int count = 0;
    for (int k = 0; k < LANES; k++) {
        open[k] = b->residual[k] > r->tolerance && b->residual[k] < LOST ? 1.0 : 0.0;
        count += open[k] > 0.0;
    }
    return count;
}

/* Choose the next shift and barrier of the open lanes, and count the iteration. */
static void adapt(const balance *r, balancing *b, const double *open, const double *share,
                  const double *far)
{
    for (int k = 0; k < LANES; k++) {
        if (open[k] == 0.0)
            continue;
        const double shift = b->shift[k] * (share[k] == 1.0 ? 0.3 : 1.5);
        const double barrier = b->barrier[k] * (share[k] > 0.5 ? 0.3 : 0.7);
        b->shift[k] = fmin(fmax(shift, r->least_shift), r->most_shift);
        b->barrier[k] = fmax(barrier, r->least_barrier);
        b->moved[k] = far[k];
        b->iterations[k] += 1.0;
    }
}

/* At most so many iterations. A lane that is done keeps the sign of the tangent where it ended. */
void seacage_balance(const assembly *s, const flow *f, const pattern *p, const balance *r,
                     balancing *b, bench *w)
{
    for (int32_t iteration = 0;; iteration++) {
        lane before, open, residual, far, share, sign;
        const int had = open_lanes(r, b, before);
        if (had == 0)
            return;
        linearise(s, f, p, r, b, w);
        residual_of(s, r->free, w->truth, residual);
        EACH_LANE b->residual[k] = before[k] > 0.0 ? residual[k] : b->residual[k];
        const int has = open_lanes(r, b, open);
        if (iteration == r->iterations && has == had)
            return;
        factorise(s, p, w, sign);
        EACH_LANE b->sign[k] = before[k] > 0.0 ? sign[k] : b->sign[k];
        if (has == 0 || iteration == r->iterations)
            return;
        substitute(s, p, r, w);
        longest(s, w->step, far);
        EACH_LANE share[k] = open[k] * (far[k] > r->reach ? r->reach / far[k] : 1.0);
        advance(s, b, w, share);
        adapt(r, b, open, share, far);
    }
}

/* --- layouts, for Python to compare with its own ---------------------------------------- */

#define FIELD(name) LAYOUT_FIELD(pattern, name)
const layout_row seacage_layout_pattern[] = {
    FIELD(row), FIELD(diagonal), FIELD(column), FIELD(order), FIELD(bars), FIELD(bends),
    FIELD(panels), FIELD(cylinders), FIELD(floats), FIELD(springs), FIELD(grounds),
    LAYOUT_END(pattern),
};
#undef FIELD

#define FIELD(name) LAYOUT_FIELD(balance, name)
const layout_row seacage_layout_balance[] = {
    FIELD(free), FIELD(true_rate), FIELD(tolerance), FIELD(reach), FIELD(least_barrier),
    FIELD(least_shift), FIELD(most_shift), FIELD(iterations), LAYOUT_END(balance),
};
#undef FIELD

#define FIELD(name) LAYOUT_FIELD(balancing, name)
const layout_row seacage_layout_balancing[] = {
    FIELD(position), FIELD(tension), FIELD(barrier), FIELD(shift), FIELD(moved), FIELD(sign),
    FIELD(iterations), FIELD(residual), LAYOUT_END(balancing),
};
#undef FIELD

#define FIELD(name) LAYOUT_FIELD(bench, name)
const layout_row seacage_layout_bench[] = {
    FIELD(truth), FIELD(force), FIELD(step), FIELD(zero), FIELD(tension), FIELD(bar), FIELD(blocks),
    FIELD(place), LAYOUT_END(bench),
};
#undef FIELD
