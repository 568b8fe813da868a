/* Part of kernel.c: what it works on, mirrored in kernel.py. */
#include <math.h>
#include <stdint.h>
#include <string.h>

enum { C = COMPONENTS, LANES = C == 2 ? 2 : 4, RADIAL = 0, AXIAL = C - 1, MAX_INTERVALS = 256, FACET_NODES = 6, SAMPLED = 8, CORNERS = 3 };
enum { SPACED = 16 }; /* numbers of different threads are so far apart, in cache lines of their own */
enum { AGAINST_SURFACE = 0, AGAINST_SPHERE = 1 };

/* What a contact has done so far. */
typedef struct {
    double impulse; /* of the sum of the multipliers so far, N s */
    double work;    /* on all bodies so far, J */
    double force;   /* that sum in the last step, N */
    double stored;  /* strain energy of a tip in the last step, J */
    int64_t last;   /* last step with a force, -1: none */
    int64_t split;  /* a separation of more steps divides two contacts */
    int64_t intervals;
    int64_t first_step[MAX_INTERVALS];
    int64_t last_step[MAX_INTERVALS];
    int64_t outermost; /* last candidate, in the order given, that carried a force; -1: none */
} Record;

/* A tip without mass that yields between the candidates, all of them the same node, and the nodes opposite. */
typedef struct {
    const double *flexibility; /* (count^2) G, m/N */
    const double *matrix;      /* (count^2) H = 2 G + dt^2 (1/m_opposite + 1/m_candidate), m/N */
    double *lambda;            /* (count) multipliers of the last step, N */
    double *wanted;            /* (count) work space: what H lambda has to reach, m */
    int32_t *closed;           /* (count) nodes that carried a force, the first `closings` */
    int64_t closings;
    double *factor;            /* (count^2) Cholesky's of H over the closed ones */
    int64_t factored;          /* whether it is */
} Tip;

/* Matching nodes of two bodies, the first above (+1) or below (-1) the second along the last axis. */
typedef struct {
    int64_t count;
    const int32_t *candidate;
    const int32_t *opposite;
    const double *gap;        /* initial gap, m */
    const double *compliance; /* 1 / (1/m_candidate + 1/m_opposite), kg */
    double *before;           /* (count) work space */
    double normal;
    double friction;          /* Coulomb's coefficient */
    double *sliding;          /* (count) work space */
    double rubbed;            /* work of friction on both bodies so far, J */
    Tip *tip;                 /* 0: none */
    Record record;
} Pairs;

/* A squeeze film, see film.c. */
typedef struct {
    int64_t count;           /* nodes of the film but for the one at its edge, where the pressure is 0 */
    int64_t places;          /* nodes of the bodies that move it */
    const int32_t *node;     /* (places) */
    const int32_t *corner;   /* (CORNERS count) among the places: what each node of the film moves with */
    const double *weight;    /* (CORNERS count) of their motion along the last axis in its opening */
    const double *radius;    /* (count + 1) m */
    const double *area;      /* (count) of the ring of each node, m^2 */
    double gap;              /* on the axis at the start, m */
    double curvature;        /* of the gap there, in r^2, 1/m */
    double minimum_gap;      /* that resists, m */
    int64_t rates;           /* entries of the viscosity's table; 1: Newtonian */
    double first_rate;       /* of shear, apparent, of the first one, 1/s */
    double log_ratio;        /* of neighbouring rates */
    const double *viscosity; /* (rates) effective, Pa s */
    double *pressure;        /* (count) of the last step, Pa */
    double *flow;            /* (count) per width between each node and the next, last step, m^2/s */
    double *load;            /* (count) of the last step, N */
    double *before;          /* (count) work space: rate of opening before the step, m/s */
    double force;            /* that pushes the bodies apart, last step, N */
    double impulse;          /* of it so far, N s */
    double work;             /* on both bodies so far, J */
} Film;

/* Elements that may yield, see plastic.c. */
typedef struct {
    int64_t elements;
    int64_t nodes;           /* of these elements */
    const int32_t *touched;  /* (nodes) them */
    const int32_t *node;     /* (4 elements) */
    const double *gradient;  /* (elements 12 points) dN/dr of the corners, dN/dz, N/r, 1/m */
    const double *weight;    /* (elements points) 2 pi r dr dz, m^3 */
    const double *shear;     /* (elements) modulus, Pa */
    const double *yield;     /* (elements) strength, Pa */
    const double *hardening; /* (elements) its slope over the plastic strain, Pa */
    const double *rate;      /* (elements) of strain that doubles the yield stress, 1/s; 0: none */
    const double *exponent;  /* (elements) of the rate */
    double *strain;          /* (elements 4 points) plastic: rr, tt, zz, twice rz */
    double *accumulated;     /* (elements points) equivalent plastic strain */
    double *work;            /* (elements) plastic, so far, J */
    double *force;           /* (2 nodes of the system) load of the plastic strain, N */
} Plastic;

/* A rigid body that only friction turns; vectors have room for three components. */
typedef struct {
    double mobility[9]; /* 3x3 inverse mass, zero along directions that are guided, 1/kg */
    double turning[9];  /* 3x3 inverse inertia about its centre, zero about guided axes, 1/(kg m^2) */
    double mass;        /* kg */
    double u[3];        /* displacement, m */
    double v[3];        /* velocity at half steps, m/s */
    double spin[3];     /* at half steps, rad/s */
    double before[3];   /* velocity before the step, m/s */
    double spun[3];     /* spin before the step, rad/s */
    double force[3];    /* of the contacts in the last step, N */
} Rigid;

typedef struct {
    int32_t kind;
    int32_t count;         /* candidates */
    const int32_t *node;   /* (count) */
    const int32_t *facet;  /* (6 count) nodes of the facet opposite, kind AGAINST_SURFACE */
    const double *weight;  /* (6 count) shape functions there; zero where there is no node */
    double *normal;        /* (C count) from the facet or the sphere's centre to the candidate */
    double *gap;           /* (count) initial gap, m; of a sphere: at the predicted place */
    const double *place;   /* (C count) kind AGAINST_SPHERE: candidate minus the centre, m */
    double radius;         /* of the sphere, m */
    int32_t rigid;         /* body the sphere belongs to */
    int32_t reserved;
    double *lambda;        /* (count) multipliers of the last step, N */
    double *compliance;    /* (count) diagonal of G M^-1 G^T, 1/kg */
    double friction;       /* Coulomb's coefficient */
    double *traction;      /* (3 count) friction on the candidates in the last step, N; only with friction */
    int32_t *active;       /* (count) work space */
    double rubbed;         /* work of friction on both sides so far, J */
    double impulse[3];     /* on the candidates so far, N s */
    double force[3];       /* on the candidates in the last step, N */
    Record record;         /* of forces along each candidate's own normal */
} Contact;

/* What drives a stack, see voltage.c. */
typedef struct {
    int64_t node;             /* the tip, in the numbering of the system */
    double force_per_voltage; /* alpha, N/V */
    double capacitance;       /* C_S of the stack held at its length, F */
    double source;            /* V_0, V */
    double resistance;        /* Ohm; 0: the source is the voltage */
    double elastance;         /* of the buffer, 1/F */
    double charge;            /* C */
    double extension;         /* at the start of the step, m */
    double force;             /* in the step, N */
    double before;            /* velocity of the tip before it, m/s */
    double impulse;           /* on the tip so far, N s */
    double work;              /* on the tip so far, J */
    double heat;              /* in the resistor so far, J */
} Voltage;

typedef struct {
    int64_t nodes;          /* surface nodes that can touch */
    const int32_t *global;  /* (nodes) their number in the system */
    const double *inverse;  /* (C nodes) 1/m, zero where fixed */
    double *u;              /* (C nodes) work space: displacement */
    double *predicted;      /* (C nodes) velocity after the predictor */
    double *before;         /* (C nodes) velocity before it */
    double *force;          /* (C nodes) result, N */
    int32_t contacts;
    int32_t rigids;
    int64_t matched;
    Contact *contact;
    Rigid *rigid;
    Pairs *pairs;           /* (matched), in the numbering of the system */
    Film *film;             /* 0: none */
    Plastic *plastic;       /* 0: none */
    Voltage *voltage;       /* of a stack; 0: none */
    double dt;
    double tolerance;       /* of the multipliers, over the largest one */
    int64_t step;           /* steps done */
    int64_t sweeps;         /* Gauss-Seidel sweeps so far */
    int64_t unconverged;    /* steps that reached the largest number of sweeps */
    double reaction[3];     /* impulse of the supports on the bodies so far, N s */
} Problem;

#if COMPONENTS == 2
/* The elements of one level, and of their rows those of one part: a part is what one thread sums. First come the
 * rows at its border, which also have neighbours outside it: all of these read each other's displacements, so a
 * node at a border moves when every part is done. The other rows come in four groups: nodes that also have faster
 * elements (they only receive the impulse), last those of them that are held somewhere; then nodes that move with this
 * level, last those of them that are held. Later rows never read the displacement of a row that moves. */
typedef struct {
    int64_t border_shared; /* ends of the groups */
    int64_t border;
    int64_t shared_free;
    int64_t shared;
    int64_t free;
    int64_t rows;
    const int32_t *node;   /* (rows) */
    const int64_t *row;    /* (rows + 1) first block of each row */
    const int32_t *column; /* the row's own node, then those of later rows */
    const double *block;   /* (C^2 per block), the upper half of K_l; row by row, of two components column by column */
    const int64_t *outer;  /* (border + 1) first block of each row with a node outside the part */
    const int32_t *outer_column;
    const double *outer_block;
} Part;
#else
/* The elements of one level at the nodes of one part, and what moves with them: a part is what one thread sums. */
typedef struct {
    int64_t number;        /* of the part */
    const int32_t *part;   /* part of each node */
    int64_t size;          /* nodes of an element, 4 or 10 */
    int64_t fours;         /* elements, by fours; the last may be filled up with ones without stiffness */
    const double *element; /* (fours, 11, 4), see elements.c */
    const int32_t *node;   /* (fours, size, 4) */
    int64_t free;          /* end of the nodes that are free */
    int64_t moving;        /* end of those that are held somewhere */
    const int32_t *moves;  /* (moving) nodes of the part that move with the level */
} Part;
#endif

/* Nodes of one body that move with one level, in a system in which some body relaxes; see relaxation.c. */
typedef struct {
    int64_t level;
    int64_t count;
    int64_t entries;       /* extensions of a node, C of each term of the body; 0: elastic */
    const int32_t *node;   /* (count) */
    double lasting;        /* 1 - sum of the ratios: share of the modulus that does not relax */
    const double *ratio;   /* (entries) share g of each spring */
    const double *decay;   /* (entries) exp(-h / tau) over the level's time step h */
    const double *growth;  /* (entries) tau (1 - exp(-h / tau)), s */
} Relaxing;

typedef struct {
    int64_t nodes;
    int64_t levels;
    int64_t parts;
    const Part *part;       /* (levels, parts) */
    const double *inverse;  /* (C nodes) 1/m, zero where fixed */
    double *u;              /* (C nodes) displacement */
    double *effective;      /* (C nodes) displacement that K acts on: u itself, or see relaxation.c */
    double *v;              /* (C nodes) velocity at half steps */
    double *f;              /* (LANES (nodes + parts)) work space, zero between steps; of two components without those of the parts */
    double *support;        /* (SPACED parts) impulse of the supports on each part, not yet in the problem's, N s */
    int64_t relaxings;      /* 0: all bodies are elastic */
    const Relaxing *relaxing;
    int64_t springs;        /* most terms of any body */
    double *extension;      /* (C springs nodes) m */
    Problem *problem;
} State;
