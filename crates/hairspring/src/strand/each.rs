//! Loops over constants that must not stay loops, so that what they index is registers.

/// `body` once for each of the indices; without any, for those below 12, the widest window of a band (the compiler unrolls no nest of
/// this size).
macro_rules! each {
    ($i:ident, $body:block) => {
        each!($i of 0 1 2 3 4 5 6 7 8 9 10 11, $body)
    };
    ($i:ident of $($k:literal)*, $body:block) => {
        $({
            let $i: usize = $k;
            $body
        })*
    };
}
