"""What of the paper no number here can be held against, and where it is at odds with itself."""

UNJUDGED = (
    (
        "Its error figures. They stand in its plots, not in its text, and its field and "
        "simulator are closed; a kilonewton here is of another cage in another sea."
    ),
    (
        "Its simulator. FhSim cannot be had; its part is played by seacage's own low fidelity, "
        "which has the cage's published dimensions and another code."
    ),
    (
        "Its field. Measured data of the cage are not public; every reading here is of a "
        "virtual field, whose truth is a simulation with other physics and hidden parameters."
    ),
    (
        "Its times. Ten minutes on 56 cores for half an hour simulated, and answers within "
        "seconds, are of other programs on other machines."
    ),
    ("Figures for more than one winter, which the paper asks for itself."),
)
"""What could not be judged, and why."""

INCONSISTENT = (
    (
        "The harsh case is test index 31 in the text and 301 in the figure's caption; the mild "
        "one is 801 in both. All three end in 1, as they would if every tenth of 1,000 cases "
        "were a test, so both may be meant; neither sea is given. Here the harsh and the mild "
        "net are the test cases at the 95th and the 20th percentile of the current's speed."
    ),
    (
        "The network predicts coordinates where its output matrix is defined and displacements "
        "where its loss is. The two differ by a constant, so do not differ in error. "
        "Coordinates are drawn here. For the modes it matters: not centred, they are taken of "
        "displacements here."
    ),
    (
        "The matrix of modes multiplies from the wrong side: B = M φ does not fit M's shape, "
        "φᵀM does, and gives the three rows that the text describes."
    ),
    (
        "The reconstruction sums over modes and over scenarios; summed over scenarios it would "
        "be one shape. Here, as in a later sentence of the paper, over modes alone."
    ),
    (
        "Level 2 is said to need training inputs that level 1 has too. It is trained at "
        "measured currents on level 1's mean there, so it does not."
    ),
    (
        "A kernel of two inputs is said to have 2d + 3 hyperparameters; with one variance for "
        "each of three factors and d + 1 + d weights it has 2d + 4, or 2d + 3 where the "
        "product's variances are counted once."
    ),
    (
        "The simulations have waves of up to 3 m, the models hear the current alone. So the "
        "waves are noise to them, and bound what any model of the current can reach."
    ),
)
"""Where the paper says two things, and what was chosen here."""
