/* Forces for Python, and the way to rest by relaxation. */
#include "_forces.h"
#include "_isa.h"
#include "_layout.h"

int32_t seacage_lanes(void) { return LANES; }

/* All forces at given positions; `rate` is each bar's true spring rate, `bars` its tension. */
void seacage_forces(const assembly *s, const flow *w, const double *rate, const double *zero,
                    double *bars, const vec *x, vec *f)
{
    add_forces(s, w, rate, zero, bars, x, f);
}

typedef struct {
    const double *inverse_mass; /* [node] fictitious; 0 holds a node */
    const double *soft_rate;    /* [bar] spring rates while relaxing */
    const double *true_rate;    /* [bar] EA / length */
    double tolerance;           /* residual at which a case is done [N] */
    double progress;            /* a residual below this share of the best is progress */
    double most_damping;        /* share of velocity lost in a step, at most */
    int32_t patience;           /* rounds without progress before more damping */
    int32_t steps, rounds;      /* steps of a round, rounds of this call */
} relaxation;

typedef struct {
    vec *position, *velocity; /* [node] */
    double *carried;          /* [bar][lane] tension that each bar was told to bear */
    double *damping, *best, *stalled, *rounds, *residual; /* [lane] */
} relaxing;

/* Dynamic relaxation to equilibrium, in rounds that can be taken up again.
 *
 * True spring rates make the way to rest some ten times longer than the shape needs, so the
 * steps run with soft bars. After each round every bar is told to bear what it has come to
 * bear (method of multipliers): stretch and tension then meet Hooke's law with the true rate
 * ever more closely, and no bar goes slack or taut at once. A net in fast water can flutter
 * on this made-up clock; a case whose residual stops falling gets more damping.
 *
 * The residual is that of the true law; a case is done when it is below the tolerance, or
 * has left the finite numbers. tension: [bar][lane], force: [node], both for work.
 */
void seacage_relax(const assembly *s, const flow *w, const relaxation *r, relaxing *state,
                   double *restrict tension, vec *restrict f)
{
    vec *restrict x = state->position, *restrict v = state->velocity;
    double *restrict carried = state->carried;
    const double *restrict damping = state->damping;
    for (int32_t round = 0; round < r->rounds; round++) {
        double live[LANES], soft_residual[LANES], true_residual[LANES];
        int running = 0;
        for (int k = 0; k < LANES; k++) {
            live[k] = state->residual[k] > r->tolerance && state->residual[k] < LOST ? 1.0 : 0.0;
            running += live[k] > 0.0;
        }
        if (running == 0)
            return;
        for (int32_t step = 0; step < r->steps; step++) {
            add_forces(s, w, r->soft_rate, carried, tension, x, f);
            for (int i = 0; i < s->nodes; i++) {
                const double inverse = r->inverse_mass[i];
                for (int a = 0; a < 3; a++)
                    EACH_LANE {
                        v[i][a][k] = (1.0 - damping[k]) * v[i][a][k] + inverse * f[i][a][k];
                        x[i][a][k] += live[k] * v[i][a][k];
                    }
            }
        }
        add_forces(s, w, r->soft_rate, carried, tension, x, f);
        residual_of(s, r->inverse_mass, f, soft_residual);
        for (int b = 0; b < s->bars; b++)
            EACH_LANE carried[b * LANES + k] += live[k] * (tension[b * LANES + k]
                                                           - carried[b * LANES + k]);
        /* with the true rate the law does not depend on what the bars carried */
        add_forces(s, w, r->true_rate, carried, tension, x, f);
        residual_of(s, r->inverse_mass, f, true_residual);
        for (int k = 0; k < LANES; k++) {
            if (live[k] == 0.0)
                continue;
            state->residual[k] = true_residual[k];
            state->rounds[k] += 1.0;
            if (soft_residual[k] < r->progress * state->best[k]) {
                state->best[k] = soft_residual[k];
                state->stalled[k] = 0.0;
                continue;
            }
            state->stalled[k] += 1.0;
            if (state->stalled[k] == r->patience) {
                const double more = 1.5 * state->damping[k];
                state->damping[k] = more < r->most_damping ? more : r->most_damping;
                state->best[k] = soft_residual[k];
                state->stalled[k] = 0.0;
            }
        }
    }
}

/* --- layouts, for Python to compare with its own ---------------------------------------- */

#define FIELD(name) LAYOUT_FIELD(assembly, name)
const layout_row seacage_layout_assembly[] = {
    FIELD(nodes), FIELD(bars), FIELD(bends), FIELD(panels), FIELD(cylinders), FIELD(floats),
    FIELD(springs), FIELD(grounds), FIELD(bar_ends), FIELD(bend_nodes), FIELD(panel_corners),
    FIELD(cylinder_ends), FIELD(float_nodes), FIELD(spring_nodes), FIELD(ground_nodes),
    FIELD(weight), FIELD(bar_length), FIELD(bar_stiffness), FIELD(bar_least),
    FIELD(bend_stiffness), FIELD(bend_plane), FIELD(bend_turn),
    FIELD(panel_share), FIELD(panel_outline), FIELD(cylinder_width),
    FIELD(float_stiffness), FIELD(float_draft), FIELD(float_height), FIELD(spring_place),
    FIELD(spring_stiffness), FIELD(spring_preload), FIELD(ground_stiffness), FIELD(ground_level),
    LAYOUT_END(assembly),
};
#undef FIELD

#define FIELD(name) LAYOUT_FIELD(flow, name)
const layout_row seacage_layout_flow[] = {
    FIELD(direction), FIELD(panel), FIELD(pipe_direction), FIELD(pipe_pressure), LAYOUT_END(flow),
};
#undef FIELD

#define FIELD(name) LAYOUT_FIELD(relaxation, name)
const layout_row seacage_layout_relaxation[] = {
    FIELD(inverse_mass), FIELD(soft_rate), FIELD(true_rate), FIELD(tolerance), FIELD(progress),
    FIELD(most_damping), FIELD(patience), FIELD(steps), FIELD(rounds), LAYOUT_END(relaxation),
};
#undef FIELD

#define FIELD(name) LAYOUT_FIELD(relaxing, name)
const layout_row seacage_layout_relaxing[] = {
    FIELD(position), FIELD(velocity), FIELD(carried), FIELD(damping), FIELD(best), FIELD(stalled),
    FIELD(rounds), FIELD(residual), LAYOUT_END(relaxing),
};
#undef FIELD
