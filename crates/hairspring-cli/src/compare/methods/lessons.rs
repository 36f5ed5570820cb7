//! Text of the report about each method: its equations, their source, and what to look for.

use hairspring::settings::Integrator;

/// The explanation of a method for a reader who is new to it.
pub struct Lesson {
    /// Name of the method.
    pub title: &'static str,
    /// Equations of a step.
    pub equations: &'static str,
    /// Source of the equations.
    pub source: &'static str,
    /// Why the method behaves as it does; HTML.
    pub text: &'static str,
}

/// The springs, which all methods except follow the leader share.
pub const SPRINGS: &str = "\
<h2>The springs</h2>
<p>A strand is a chain of points x₀ … x₍ₙ₋₁₎ with masses m. The scalp moves the first two; every other point obeys Newton, m a = f. A spring
along each segment pulls its ends together or pushes them apart:</p>
<pre>f = k (ℓ − L) û       ℓ the current length, L the rest length, û the direction,  k = EA/L</pre>
<p>A bending spring at each joint pulls the change of tangent r = u₂ − u₁ − d back to zero, where d is the change at rest:</p>
<pre>E = ½ B |r|²          B = EI/L</pre>
<p>E is Young's modulus of keratin, A the cross-section of a fiber, and I = πr⁴/4: hair is hard to stretch and easy to bend. A segment of hair
vibrates lengthwise at about 10⁶ rad/s, while the strand swings at about 10 rad/s as a whole. A system is called <em>stiff</em> if its fastest
motion is this much faster than the one that matters. The methods below differ in how they handle stiffness. <small>Sams 2014, §3.1; Lengyel 2012; bending springs
after Bergou et al. 2008, <i>Discrete Elastic Rods</i>.</small></p>
";

/// The question that the methods answer.
pub const QUESTION: &str = "\
<h2>The methods</h2>
<p>A method computes the positions x⁺ and velocities v⁺ at a time h later from the current x and v. The acceleration a = f/m is known at the
current positions. An <em>explicit</em> method uses it; an <em>implicit</em> method uses the acceleration at the new positions. <small>Sams 2014, §3.2.</small></p>
";

/// Contact, which is the same for all methods.
pub const CONTACT: &str = "\
<h2>Contact</h2>
<p>Contact is the same for all methods and follows the computation of new positions. A point inside the head is moved to the nearest position
outside, its inward velocity is removed, and friction reduces its motion along the surface by up to μ times that correction. <small>Sams 2014, §3.3; Liu et al.
2013.</small></p>
";

/// Returns the explanation of a method.
pub fn lesson(integrator: Integrator) -> Lesson {
    match integrator {
        Integrator::ExplicitEuler => Lesson {
            title: "Explicit Euler",
            equations: "x⁺ = x + h v\nv⁺ = v + h a(x, v)",
            source: "Sams 2014, §3.2; Müller et al. 2008, Real Time Physics, §3.3",
            text: "Each step follows the tangent and so always leaves a circular orbit to the outside: the amplitude of a spring \
                   with angular frequency ω grows by √(1 + h²ω²) in every step. No step length avoids this; a shorter step only \
                   makes the growth slower. For the lengthwise ω of hair, the step would have to be far below a microsecond. The \
                   method is included to show why the others exist.",
        },
        Integrator::Verlet => Lesson {
            title: "Verlet",
            equations: "a  = f(x, v) / m\nx⁺ = 2x − x⁻ + h² a  =  x + h v + h² a\nv⁺ = (x⁺ − x) / h",
            source: "Sams 2014, §3.2; Müller et al. 2008, Real Time Physics, §3.3",
            text: "The velocity is not stored but derived from the last two positions, so that a force acts on the position at \
                   once. This small change keeps orbits closed: energy oscillates around its value and does not grow, as long as \
                   h ω &lt; 2. Beyond that bound the method blows up like explicit Euler. With ω of the shortest segment the \
                   bound is about h &lt; L √(ρ/E), the time that sound takes to cross the segment. This is a few microseconds, so \
                   a picture needs thousands of steps.",
        },
        Integrator::BackwardEuler => Lesson {
            title: "Backward Euler (the default)",
            equations: "x⁺ = x + h v⁺\nv⁺ = v + h a(x⁺, v⁺)\n\nlinearized, for Δ = x⁺ − x:   (M/h² + D/h + K) Δ = M v/h + f(x)",
            source: "Sams 2014, §3.2; Baraff & Witkin 1998, Large Steps in Cloth Simulation; Tariq & Bavoil 2010; Goldenthal et al. 2007",
            text: "The unknown is on both sides, so a linear system must be solved. A force reaches at most two points further, \
                   so the matrix is a narrow band, and one sweep down and up the strand solves it exactly. The amplitude of a \
                   spring with angular frequency ω now shrinks by 1/√(1 + h²ω²): motion that is too fast for the step dies out \
                   instead of growing. The price is that the swing is damped too: it loses more energy the longer the step is. \
                   Full stiffness is too much even for one linear solve. A softer spring takes its place, and a projection then \
                   corrects the lengths to within 1 %.",
        },
        Integrator::Bdf2 => Lesson {
            title: "BDF2",
            equations: "x⁺ = (4x − x⁻ + 2h v⁺) / 3\nv⁺ = (4v − v⁻ + 2h a(x⁺, v⁺)) / 3",
            source: "Choi & Ko 2002, Stable but Responsive Cloth, eq. 17",
            text: "This is the backward differentiation formula of second order. It uses the two previous steps, so that the \
                   error of a slow swing decreases with h² instead of h and its amplitude is kept. The system to solve is that of \
                   backward Euler with 9/4 of the mass, and costs the same.",
        },
        Integrator::LocalGlobal => Lesson {
            title: "Local–global",
            equations: "local:   d = L û for every segment alone, d = its turn at rest for every joint\nglobal:  (M/h² + Σ k AᵀA) x⁺ = M x̂/h² + Σ k Aᵀ d        x̂ = x + h v + h² g\nagain, ten times",
            source: "Liu et al. 2013, Fast Simulation of Mass-Spring Systems",
            text: "This is the same implicit step, seen as a search for the positions of least energy. The local step finds for \
                   every spring on its own where it would be at rest. The global step reconciles all of them with a constant \
                   matrix that is factored once. No iteration can overshoot, so the method cannot blow up, but ten iterations do \
                   not converge. The remaining error acts as friction against rotation, and as stretch if steps are long. Bending \
                   works only in a frame that is carried along the strand, without twist.",
        },
        Integrator::Ftl => Lesson {
            title: "Follow the leader",
            equations: "p  = x + h v + h² g\nfrom root to tip:  x⁺ᵢ₊₁ = x⁺ᵢ + L û(x⁺ᵢ → pᵢ₊₁)\nv⁺ = (x⁺ − x) / h",
            source: "Sams 2014, §2.1.2; Müller, Kim, Chentanez 2012, Fast Simulation of Inextensible Hair and Fur, §4.1",
            text: "Every point is moved to its rest distance from the previous point, once, from root to tip. All lengths are \
                   exact until contact moves a point, and no step is too long. But a point never pulls its leader back. It moves \
                   as if the leader were infinitely heavier, which turns the chain into a whip: the points near the tip gain \
                   energy from nowhere. There is no bending stiffness, so curls straighten.",
        },
        Integrator::Dftl => Lesson {
            title: "Dynamic follow the leader",
            equations: "as follow the leader, with d the correction p → x⁺ of a point, and then\nv⁺ᵢ = (x⁺ᵢ − xᵢ) / h − s dᵢ₊₁ / h        s = 0.9",
            source: "Müller, Kim, Chentanez 2012, §4.2",
            text: "The correction of a point is subtracted from the velocity of its leader, as if the point had pulled the leader \
                   back. The whip effect is gone, but a damping remains that depends on the step. The method is very cheap, keeps \
                   all lengths, and suits fur that needs no shape of its own.",
        },
        other => Lesson { title: other.name(), equations: "", source: "", text: "" },
    }
}
