//! What the report says of each method: its equations, where they are from, and what to look for.

use hairspring::settings::Integrator;

/// A method, for somebody who meets it for the first time.
pub struct Lesson {
    /// Its name in words.
    pub title: &'static str,
    /// How a step goes.
    pub equations: &'static str,
    /// Where that is from.
    pub source: &'static str,
    /// Why it behaves as it does; HTML.
    pub text: &'static str,
}

/// The springs that all methods but follow the leader share.
pub const SPRINGS: &str = "\
<h2>The springs</h2>
<p>A strand is a chain of points x₀ … x₍ₙ₋₁₎ with masses m. The scalp drives the first two; every other point obeys Newton, m a = f. A spring
along each segment pulls its ends together or pushes them apart:</p>
<pre>f = k (ℓ − L) û       ℓ its length now, L at rest, û its direction,  k = EA/L</pre>
<p>and a bending spring at each joint pulls the change of tangent r = u₂ − u₁ − d back to zero, where d is the turn that the joint has at
rest:</p>
<pre>E = ½ B |r|²          B = EI/L</pre>
<p>E is Young's modulus of keratin, A the area of a fibre and I = πr⁴/4: hair is hard to stretch and easy to bend. A segment of hair rings at
some 10⁵ rad/s lengthwise and swings at some 10 rad/s as a whole. A system whose fastest motion nobody wants to see and whose slowest is the
picture is called <em>stiff</em>, and stiffness is what tells the methods below apart. <small>Sams 2014, §3.1; Lengyel 2012; the springs of bending
after Bergou et al. 2008, <i>Discrete Elastic Rods</i>.</small></p>
";

/// The question that the methods answer.
pub const QUESTION: &str = "\
<h2>The methods</h2>
<p>From positions x and velocities v now, what are they a time h later, x⁺ and v⁺? The acceleration a = f/m is known where the points are now; an
<em>explicit</em> method uses it, an <em>implicit</em> one asks for the acceleration where they will be. <small>Sams 2014, §3.2.</small></p>
";

/// Contact, which is the same for all.
pub const CONTACT: &str = "\
<h2>Contact</h2>
<p>All methods meet the head in the same way, after their own positions are found: a point inside is moved to the nearest place outside, its
motion inwards is dropped, and friction holds it back along the surface by up to μ times that push. <small>Sams 2014, §3.3; Liu et al.
2013.</small></p>
";

/// The lesson of a method.
pub fn lesson(integrator: Integrator) -> Lesson {
    match integrator {
        Integrator::ExplicitEuler => Lesson {
            title: "Explicit Euler",
            equations: "x⁺ = x + h v\nv⁺ = v + h a(x, v)",
            source: "Sams 2014, §3.2; Müller et al. 2008, Real Time Physics, §3.3",
            text: "It follows the tangent, and so always leaves a circle on the outside: a spring that rings at ω grows by √(1 + h²ω²) in every \
                   step. There is no step at which it does not, only steps so short that the growth is not seen yet, and hair's \
                   lengthwise ω puts those far below a microsecond. It is here to show why the others exist.",
        },
        Integrator::Verlet => Lesson {
            title: "Verlet",
            equations: "a  = f(x, v) / m\nx⁺ = 2x − x⁻ + h² a  =  x + h v + h² a\nv⁺ = (x⁺ − x) / h",
            source: "Sams 2014, §3.2; Müller et al. 2008, Real Time Physics, §3.3",
            text: "The velocity is not stored but read off the last two positions, so that force acts on position at once. That small change keeps \
                   circles closed: energy wavers about its value and does not grow, as long as h ω &lt; 2. Beyond that it blows up like explicit \
                   Euler. With ω from the shortest segment the bound is about h &lt; L √(ρ/E), the time that sound takes \
                   through it: microseconds, thousands of steps where a picture needs one.",
        },
        Integrator::BackwardEuler => Lesson {
            title: "Backward Euler (the default)",
            equations: "x⁺ = x + h v⁺\nv⁺ = v + h a(x⁺, v⁺)\n\nlinearised, for Δ = x⁺ − x:   (M/h² + D/h + K) Δ = M v/h + f(x)",
            source: "Sams 2014, §3.2; Baraff & Witkin 1998, Large Steps in Cloth Simulation; Tariq & Bavoil 2010; Goldenthal et al. 2007",
            text: "The unknown stands on both sides, so a linear system is solved; every force reaches at most the next but one point, the matrix is a \
                   narrow band, and one sweep down and up the strand solves it exactly. A spring that rings at ω now shrinks by \
                   1/√(1 + h²ω²): whatever is too fast for the step dies instead of growing. The price is that the swing dies a \
                   little too: its energy falls, the more the longer the step. Full stiffness is too much even for one linear solve, \
                   so a softer spring stands in for it, and a projection then puts the lengths right, 1 % at most apart.",
        },
        Integrator::Bdf2 => Lesson {
            title: "BDF2",
            equations: "x⁺ = (4x − x⁻ + 2h v⁺) / 3\nv⁺ = (4v − v⁻ + 2h a(x⁺, v⁺)) / 3",
            source: "Choi & Ko 2002, Stable but Responsive Cloth, eq. 17",
            text: "The backward differentiation formula of second order: it looks two steps back, so that a slow swing's error falls with h² instead of \
                   h and its amplitude lives. The system to solve is backward Euler's with 9/4 of the mass, and costs the same.",
        },
        Integrator::LocalGlobal => Lesson {
            title: "Local–global",
            equations: "local:   d = L û for every segment alone, d = its turn at rest for every joint\nglobal:  (M/h² + Σ k AᵀA) x⁺ = M x̂/h² + Σ k Aᵀ d        x̂ = x + h v + h² g\nagain, ten times",
            source: "Liu et al. 2013, Fast Simulation of Mass-Spring Systems",
            text: "The same implicit step, seen as a search for the positions of least energy. Every spring first says by itself where it would be at \
                   rest; then all wishes are reconciled by a matrix that never changes and is factored once. No iteration can \
                   overshoot, so it cannot blow up; but ten do not get to the end. What is missing acts as friction against turning, and \
                   as stretch where steps are long. It knows bending in a carried frame only, without twist.",
        },
        Integrator::Ftl => Lesson {
            title: "Follow the leader",
            equations: "p  = x + h v + h² g\nfrom root to tip:  x⁺ᵢ₊₁ = x⁺ᵢ + L û(x⁺ᵢ → pᵢ₊₁)\nv⁺ = (x⁺ − x) / h",
            source: "Sams 2014, §2.1.2; Müller, Kim, Chentanez 2012, Fast Simulation of Inextensible Hair and Fur, §4.1",
            text: "Every point is pulled to its distance from the one before, root to tip, once: no length is wrong until contact moves a point, and no step is too long. But \
                   a point never pulls back at its leader. It moves as if the leader were infinitely heavier, which makes a whip of a \
                   chain: the points near the tip get energy from nowhere. Nothing bends it either, so curls hang out straight.",
        },
        Integrator::Dftl => Lesson {
            title: "Dynamic follow the leader",
            equations: "as follow the leader, with d the correction p → x⁺ of a point, and then\nv⁺ᵢ = (x⁺ᵢ − xᵢ) / h − s dᵢ₊₁ / h        s = 0.9",
            source: "Müller, Kim, Chentanez 2012, §4.2",
            text: "The correction of a point is taken from the velocity of its leader, as if the leader had been pulled back after all. The whip is \
                   gone; what stays is a damping that depends on the step. Very cheap, never long, and right for fur that needs no shape \
                   of its own.",
        },
    }
}
