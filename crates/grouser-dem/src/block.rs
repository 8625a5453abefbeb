//! One block of contacts on its way through a pass: filter, gather, contact law, ordered scatter.

#[cfg(target_arch = "x86_64")]
use crate::force_pass::{InstructionSet, in_quads};
use crate::force_pass::{PassInput, Waiting};
#[cfg(target_arch = "x86_64")]
use crate::quads;
use crate::shared_grains::SharedGrains;
use crate::slab::{Pair, Slab, SlabSums};
use grouser_contact::{
    BLOCK, Blocked, Body, Contact, ContactLaw, ContactLedger, Frame, Lanes, PairTable, Precision, Quaternion,
    Real, RotationLaw, Vector,
};

/// What law `L` asks to know about orientations.
pub(crate) type FrameOf<T, L> = <<L as ContactLaw<T>>::Rotation as RotationLaw<T>>::Frame;

/// Grains turn as spheres do; known when compiled.
const fn turns_as_sphere<T: Real, L: ContactLaw<T>>() -> bool {
    <L::Rotation as RotationLaw<T>>::IS_SPHERE
}

/// The two types are one; known when compiled.
#[inline(always)]
fn is_same<A: 'static, B: 'static>() -> bool {
    std::any::TypeId::of::<A>() == std::any::TypeId::of::<B>()
}

/// The law asks for orientations as quaternions; known when compiled.
#[inline(always)]
fn has_quaternions<T: Real, L: ContactLaw<T>>() -> bool {
    is_same::<FrameOf<T, L>, Quaternion<T>>()
}

/// A contact remembers one vector and no more; known when compiled.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn remembers_a_vector<T: Real, L: ContactLaw<T>>() -> bool {
    is_same::<L::Memory, Vector<T>>() || is_same::<L::Memory, (Vector<T>, ())>()
}

/// A contact remembers a vector and a number; known when compiled.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn remembers_four_numbers<T: Real, L: ContactLaw<T>>() -> bool {
    is_same::<L::Memory, (Vector<T>, T)>()
}

/// Starts of `N` arrays of lanes that follow each other.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn lanes_from<U, const N: usize>(first: *mut U) -> [*mut U; N] {
    let mut lanes = [first; N];
    for n in 1..N {
        lanes[n] = first.wrapping_add(n * BLOCK);
    }
    lanes
}

/// Starts of the lanes of a vector and a number, in the order in which a contact remembers the four numbers.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn lanes_of_four<T: Real, U>(block: *mut <(Vector<T>, T) as Blocked<T>>::Block) -> [*mut U; 4] {
    // SAFETY: places of fields, of which nothing is read.
    let (vector, number) = unsafe { (&raw mut (*block).0, &raw mut (*block).1) };
    let ([x, y, z], number) = (lanes_from(vector.cast()), number.cast());
    if std::mem::offset_of!((Vector<T>, T), 1) == 0 { [number, x, y, z] } else { [x, y, z, number] }
}

/// Lanes that loops over a block go through at a time: a number that every vector width divides.
const GROUP: usize = 16;

/// One number for each lane of a group.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
struct Group<T>([T; GROUP]);

impl<T: Real> Default for Group<T> {
    fn default() -> Self {
        Self([T::ZERO; GROUP])
    }
}

/// One component for each contact of a block. Inputs are overwritten by outputs where both have three components.
pub(crate) struct Block<T: Real, L: ContactLaw<T>> {
    /// Centre of the second body to centre of the first [m]; after the law the force on the first [N].
    difference: [Lanes<T>; 3],
    /// (r₁ + r₂)² − distance² [m²], taken in the precision of coordinates.
    excess: Lanes<T>,
    radius: [Lanes<T>; 2],
    mass: [Lanes<T>; 2],
    /// Velocity of the first centre against the second [m/s]; after the law n × F [N].
    velocity: [Lanes<T>; 3],
    /// Spins [rad/s]; after a law that does not turn grains as spheres the torques [N·m].
    spin: [[Lanes<T>; 3]; 2],
    /// Orientations, where the law asks for them.
    frame: [<FrameOf<T, L> as Blocked<T>>::Block; 2],
    /// Distance of the contact point from each centre [m].
    arm: [Lanes<T>; 2],
    /// R* [m].
    effective_radius: Lanes<T>,
    /// m* [kg].
    effective_mass: Lanes<T>,
    memory: <L::Memory as Blocked<T>>::Block,
    normal_modulus: Lanes<T>,
    tangential_modulus: Lanes<T>,
    damping: Lanes<T>,
    tangential_damping_ratio: Lanes<T>,
    friction: Lanes<T>,
    /// Sums over all blocks of a pass, one for each lane of a group.
    ledger: [Group<T>; 6],
    /// How far overlaps exceed the largest one that is allowed [m], one for each lane of a group.
    depth: Group<T>,
}

/// Centre to centre [m] of a pair, and (x² + y²) + (z² − reach²) [m²]: negative where it touches.
#[inline(always)]
fn relative_place<P: Precision, L>(
    pair: Pair,
    input: &PassInput<P, L>,
) -> (Vector<P::Coordinate>, P::Coordinate) {
    let [first, second] = pair.grains().map(|grain| input.grains.sphere(grain));
    let [x, y, z, _] = input.shifts[pair.image()];
    let difference = first.position - second.position - Vector::new(x, y, z);
    let reach = first.radius + second.radius;
    let Vector { x, y, z } = difference;
    (difference, (x * x + y * y) + (z * z - reach * reach))
}

/// There are registers for this precision; known when compiled.
#[inline(always)]
fn has_quads<P: Precision>() -> bool {
    #[cfg(target_arch = "x86_64")]
    return in_quads!(P, Quads => size_of::<Quads>()).is_some();
    #[cfg(not(target_arch = "x86_64"))]
    false
}

/// Eight contacts can be gathered at once.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn has_eights<P: Precision>(set: InstructionSet) -> bool {
    is_same::<P, grouser_contact::F64>() && set == InstructionSet::Avx512
}

impl<T: Real, L: ContactLaw<T>> Block<T, L> {
    /// Lanes that hold what any law stands, for beds of materials in `table`.
    pub fn new(table: &PairTable<T>) -> Self {
        let mut block = Self {
            difference: Default::default(),
            excess: Lanes([T::from_f64(0.5); BLOCK]),
            radius: [Lanes([T::ONE; BLOCK]); 2],
            mass: [Lanes([T::ONE; BLOCK]); 2],
            velocity: Default::default(),
            spin: Default::default(),
            frame: Default::default(),
            arm: Default::default(),
            effective_radius: Default::default(),
            effective_mass: Default::default(),
            memory: Default::default(),
            normal_modulus: Default::default(),
            tangential_modulus: Default::default(),
            damping: Default::default(),
            tangential_damping_ratio: Default::default(),
            friction: Default::default(),
            ledger: Default::default(),
            depth: Default::default(),
        };
        for k in 0..BLOCK {
            block.difference[0].0[k] = T::ONE;
            block.set_pair(k, table, 0, 0);
        }
        block
    }

    /// Constants of materials `i` and `j` for contact `k`.
    #[inline(always)]
    fn set_pair(&mut self, k: usize, table: &PairTable<T>, i: u32, j: u32) {
        let pair = table.pair(i, j);
        self.normal_modulus.0[k] = pair.normal_modulus;
        self.tangential_modulus.0[k] = pair.tangential_modulus;
        self.damping.0[k] = pair.damping;
        self.tangential_damping_ratio.0[k] = pair.tangential_damping_ratio;
        self.friction.0[k] = pair.friction;
    }

    #[inline(always)]
    pub fn work<P: Precision<Real = T>, const HAS_QUADS: bool, const LEDGER: bool>(
        &mut self,
        waiting: &Waiting,
        slab: &mut Slab<T, L::Memory>,
        input: &PassInput<P, L>,
    ) {
        let places = waiting.places();
        self.gather::<P, HAS_QUADS>(waiting, slab, input);
        // Groups of lanes: a constant trip count that every vector width divides; constant bounds of their number, without which
        // the compiler looks for lanes behind the last one and works on some of them one at a time.
        for group in (0..BLOCK / GROUP).take_while(|group| group * GROUP < places.len()) {
            self.touch(group * GROUP, places.len(), input.largest_overlap);
        }
        for group in (0..BLOCK / GROUP).take_while(|group| group * GROUP < places.len()) {
            self.respond::<LEDGER>(group * GROUP, places.len(), &input.law, input.time_step);
        }
        self.scatter::<P, HAS_QUADS>(waiting, slab, input.grains);
    }

    /// Looks at pairs from `next` on, four at a time, until all are seen or the block is full; touching ones fill the lanes
    /// of positions. Gives the first pair that was not looked at.
    #[inline(always)]
    pub fn look<P: Precision<Real = T>, const HAS_QUADS: bool>(
        &mut self,
        pairs: &[Pair],
        memory: &[L::Memory],
        mut next: usize,
        from: u32,
        touching: &mut u64,
        waiting: &mut Waiting,
        input: &PassInput<P, L>,
    ) -> usize {
        #[cfg(target_arch = "x86_64")]
        if HAS_QUADS {
            let seen = in_quads!(P, Q => {
                let places = quads::Places::<Q> {
                    spheres: input.grains.spheres().cast(),
                    shifts: input.shifts.as_ptr().cast(),
                    memory: memory.as_ptr().cast(),
                    memory_bytes: size_of::<L::Memory>(),
                };
                let [x, y, z] = &mut self.difference;
                let [first, second] = &mut self.radius;
                let lanes = quads::PlaceLanes {
                    difference: [quads::start(x), quads::start(y), quads::start(z)],
                    excess: quads::start(&mut self.excess),
                    radius: [quads::start(first), quads::start(second)],
                };
                // SAFETY: this pass is compiled for AVX2, with eights for AVX-512F and AVX-512VL, and `Q` is `F64` then; `Q` is
                // `P`; lists hold numbers of grains.
                unsafe {
                    if has_eights::<Q>(input.set) {
                        let (places, lanes) = (&*(&raw const places).cast(), &*(&raw const lanes).cast());
                        next = quads::look_eight(pairs, next, from, touching, waiting, places, lanes);
                    }
                    quads::look::<Q>(pairs, next, from, touching, waiting, &places, &lanes)
                }
            });
            next = seen.unwrap_or(next);
        }
        let is_rest = pairs.len() - next < 4;
        while next < pairs.len() && waiting.has_room() && (is_rest || !HAS_QUADS || !has_quads::<P>()) {
            let end = pairs.len().min(next + 4);
            for (bit, &pair) in pairs.iter().enumerate().take(end).skip(next) {
                let touches = self.look_at_one(pair, input, waiting.n());
                *touching |= u64::from(touches) << bit;
                waiting.append_one(touches, from + bit as u32, pair);
            }
            next = end;
        }
        next
    }

    /// Fills the position lanes `k` with a pair and says whether it touches.
    #[inline(always)]
    fn look_at_one<P: Precision<Real = T>>(&mut self, pair: Pair, input: &PassInput<P, L>, k: usize) -> bool {
        let [first, second] = pair.grains().map(|grain| input.grains.sphere(grain));
        let narrow = |c: P::Coordinate| T::from_f64(c.to_f64());
        let (difference, room) = relative_place(pair, input);
        self.excess.0[k] = -narrow(room);
        let difference = difference.to_array();
        for axis in 0..3 {
            self.difference[axis].0[k] = narrow(difference[axis]);
        }
        self.radius[0].0[k] = narrow(first.radius);
        self.radius[1].0[k] = narrow(second.radius);
        room < P::Coordinate::ZERO
    }

    /// Fills the other lanes with the pairs that wait.
    #[inline(always)]
    fn gather<P: Precision<Real = T>, const HAS_QUADS: bool>(
        &mut self,
        waiting: &Waiting,
        slab: &Slab<T, L::Memory>,
        input: &PassInput<P, L>,
    ) {
        let pairs = waiting.pairs();
        let mut is_done = false;
        #[cfg(target_arch = "x86_64")]
        if HAS_QUADS {
            let gathered = in_quads!(P, Q => {
                let [[x, y, z], [x2, y2, z2]] = &mut self.spin;
                let [vx, vy, vz] = &mut self.velocity;
                let [first, second] = &mut self.mass;
                let lanes = quads::MotionLanes {
                    mass: [quads::start(first), quads::start(second)],
                    velocity: [quads::start(vx), quads::start(vy), quads::start(vz)],
                    spin: [
                        [quads::start(x), quads::start(y), quads::start(z)],
                        [quads::start(x2), quads::start(y2), quads::start(z2)],
                    ],
                    frame: [(&raw mut self.frame[0]).cast(), (&raw mut self.frame[1]).cast()],
                };
                let gather = if has_quaternions::<T, L>() { quads::gather::<Q, true> } else { quads::gather::<Q, false> };
                let (spheres, orientations) = (input.grains.spheres().cast(), input.grains.all_orientations());
                // SAFETY: as in `look`; a block has room for all that wait; a block of quaternions is four arrays of lanes; with eights this pass is compiled for AVX-512F and `Q` is `F64`.
                unsafe {
                    if has_eights::<Q>(input.set) {
                        let gather = if has_quaternions::<T, L>() { quads::gather_eight::<true> } else { quads::gather_eight::<false> };
                        let lanes = &*(&raw const lanes).cast();
                        gather(waiting, input.grains.spheres().cast(), orientations, lanes);
                    } else {
                        gather(waiting, spheres, orientations, &lanes);
                    }
                }
            });
            is_done = gathered.is_some();
        }
        if !is_done {
            for (k, &pair) in pairs.iter().enumerate() {
                self.gather_one(pair, input, k);
            }
        }
        self.recall::<P, HAS_QUADS>(waiting.places(), slab);
        if FrameOf::<T, L>::IS_TRACKED && !(is_done && has_quaternions::<T, L>()) {
            self.gather_frames(pairs, input);
        }
        if input.table.n_materials() > 1 {
            for (k, pair) in pairs.iter().enumerate() {
                let [i, j] = pair.grains();
                self.set_pair(
                    k,
                    input.table,
                    input.grains.sphere(i).material,
                    input.grains.sphere(j).material,
                );
            }
        }
    }

    /// Fills the lanes of memory.
    #[inline(always)]
    fn recall<P: Precision<Real = T>, const HAS_QUADS: bool>(
        &mut self,
        places: &[u32],
        slab: &Slab<T, L::Memory>,
    ) {
        #[cfg(target_arch = "x86_64")]
        if HAS_QUADS && remembers_a_vector::<T, L>() {
            let lanes: *mut T = (&raw mut self.memory).cast();
            let recalled = in_quads!(P, Q => {
                let lanes: [*mut <Q as Precision>::Real; 3] = lanes_from(lanes.cast());
                // SAFETY: as in `gather`; memory is vectors, a block of them three arrays of lanes, and `Q` is `P`.
                unsafe { quads::recall::<Q, 3>(slab.memory.as_ptr().cast(), places, lanes) };
            });
            if recalled.is_some() {
                return;
            }
        }
        #[cfg(target_arch = "x86_64")]
        if HAS_QUADS && remembers_four_numbers::<T, L>() {
            let block = (&raw mut self.memory).cast();
            let recalled = in_quads!(P, Q => {
                let lanes: [*mut <Q as Precision>::Real; 4] = lanes_of_four::<T, _>(block);
                // SAFETY: as above, with a vector and a number each.
                unsafe { quads::recall::<Q, 4>(slab.memory.as_ptr().cast(), places, lanes) };
            });
            if recalled.is_some() {
                return;
            }
        }
        for (group, four) in places.chunks(4).enumerate() {
            // Written out here and below: closures over arrays are not inlined into the vectorised pass.
            let memory = |n: usize| slab.memory[four[n.min(four.len() - 1)] as usize];
            L::Memory::store_four([memory(0), memory(1), memory(2), memory(3)], &mut self.memory, group * 4);
        }
    }

    /// Empties the lanes of memory into the list.
    #[inline(always)]
    fn remember<P: Precision<Real = T>, const HAS_QUADS: bool>(
        &mut self,
        places: &[u32],
        slab: &mut Slab<T, L::Memory>,
    ) {
        #[cfg(target_arch = "x86_64")]
        if HAS_QUADS && remembers_a_vector::<T, L>() {
            let lanes: *mut T = (&raw mut self.memory).cast();
            let remembered = in_quads!(P, Q => {
                let lanes: [*mut <Q as Precision>::Real; 3] = lanes_from(lanes.cast());
                let lanes = lanes.map(<*mut _>::cast_const);
                // SAFETY: as in `recall`; a pair is in a block once.
                unsafe { quads::remember::<Q, 3>(slab.memory.as_mut_ptr().cast(), places, lanes) };
            });
            if remembered.is_some() {
                return;
            }
        }
        #[cfg(target_arch = "x86_64")]
        if HAS_QUADS && remembers_four_numbers::<T, L>() {
            let block = (&raw mut self.memory).cast();
            let remembered = in_quads!(P, Q => {
                let lanes: [*mut <Q as Precision>::Real; 4] = lanes_of_four::<T, _>(block);
                let lanes = lanes.map(<*mut _>::cast_const);
                // SAFETY: as above.
                unsafe { quads::remember::<Q, 4>(slab.memory.as_mut_ptr().cast(), places, lanes) };
            });
            if remembered.is_some() {
                return;
            }
        }
        for (k, &place) in places.iter().enumerate() {
            slab.memory[place as usize] = L::Memory::load(&self.memory, k);
        }
    }

    /// Fills the lanes of orientations.
    #[inline(always)]
    fn gather_frames<P: Precision<Real = T>>(&mut self, pairs: &[Pair], input: &PassInput<P, L>) {
        for (group, four) in pairs.chunks(4).enumerate() {
            for body in 0..2 {
                let frame = |n: usize| {
                    let pair = four[n.min(four.len() - 1)];
                    FrameOf::<T, L>::from_quaternion(input.grains.quaternion(pair.grains()[body]))
                };
                let frames = [frame(0), frame(1), frame(2), frame(3)];
                <FrameOf<T, L>>::store_four(frames, &mut self.frame[body], group * 4);
            }
        }
    }

    #[inline(always)]
    fn gather_one<P: Precision<Real = T>>(&mut self, pair: Pair, input: &PassInput<P, L>, k: usize) {
        let [first, second] = pair.grains().map(|grain| input.grains.sphere(grain));
        let velocity = (first.velocity - second.velocity).to_array();
        for axis in 0..3 {
            self.velocity[axis].0[k] = velocity[axis];
        }
        for (body, sphere) in [first, second].into_iter().enumerate() {
            self.mass[body].0[k] = sphere.mass;
            let spin = sphere.spin.to_array();
            for axis in 0..3 {
                self.spin[body][axis].0[k] = spin[axis];
            }
        }
    }

    /// Where and how deep the grains of lanes `from..from + GROUP` touch. Those from `used` on hold leftovers, whose results nobody
    /// may see.
    #[inline(always)]
    fn touch(&mut self, from: usize, used: usize, largest_overlap: T) {
        let lanes =
            |group: &[Lanes<T>; 3], k: usize| Vector::new(group[0].0[k], group[1].0[k], group[2].0[k]);
        for lane in 0..GROUP {
            let k = from + lane;
            let (radii, masses) =
                ([self.radius[0].0[k], self.radius[1].0[k]], [self.mass[0].0[k], self.mass[1].0[k]]);
            let (reach, total_mass) = (radii[0] + radii[1], masses[0] + masses[1]);
            let difference = lanes(&self.difference, k);
            let distance = difference.norm();
            // One division serves 1/distance, the overlap excess/(reach + distance), R* and m*.
            let edge = reach + distance;
            let (lengths, sums) = (distance * edge, reach * total_mass);
            let inverse = T::ONE / (lengths * sums);
            let normal = (difference * (inverse * edge * sums)).to_array();
            let overlap = self.excess.0[k] * (inverse * distance * sums);
            for axis in 0..3 {
                self.difference[axis].0[k] = normal[axis];
            }
            self.excess.0[k] = overlap;
            self.effective_radius.0[k] = radii[0] * radii[1] * (inverse * lengths * total_mass);
            self.effective_mass.0[k] = masses[0] * masses[1] * (inverse * lengths * reach);
            let half = T::from_f64(0.5);
            self.arm[0].0[k] = radii[0] - half * overlap;
            self.arm[1].0[k] = radii[1] - half * overlap;
            let depth = overlap - largest_overlap * radii[0].min(radii[1]);
            let depth = if k < used { depth } else { T::ZERO };
            self.depth.0[lane] = depth.max(self.depth.0[lane]);
        }
    }

    /// The contact law on lanes `from..from + GROUP`, of which those below `used` hold contacts.
    #[inline(always)]
    fn respond<const LEDGER: bool>(&mut self, from: usize, used: usize, law: &L, time_step: T) {
        let lanes =
            |group: &[Lanes<T>; 3], k: usize| Vector::new(group[0].0[k], group[1].0[k], group[2].0[k]);
        let half = T::from_f64(0.5);
        for lane in 0..GROUP {
            let k = from + lane;
            let (radii, masses) =
                ([self.radius[0].0[k], self.radius[1].0[k]], [self.mass[0].0[k], self.mass[1].0[k]]);
            let normal = lanes(&self.difference, k);
            let arms = [self.arm[0].0[k], self.arm[1].0[k]];
            let (spin_first, spin_second) = (lanes(&self.spin[0], k), lanes(&self.spin[1], k));
            let body = |b: usize, spin| Body {
                arm: arms[b],
                spin,
                inverse_moment: T::ONE / (masses[b] * radii[b] * radii[b]),
                frame: <FrameOf<T, L>>::load(&self.frame[b], k),
            };
            let bodies = [body(0, spin_first), body(1, spin_second)];
            let centres = lanes(&self.velocity, k);
            let contact = Contact {
                overlap: self.excess.0[k],
                normal,
                velocity: law.rotation().velocity_in_parts(normal, centres, &bodies),
                normal_spin: half * (spin_first + spin_second).dot(normal),
                effective_radius: self.effective_radius.0[k],
                effective_mass: self.effective_mass.0[k],
                time_step,
            };
            let pair = grouser_contact::PairProperties {
                normal_modulus: self.normal_modulus.0[k],
                tangential_modulus: self.tangential_modulus.0[k],
                damping: self.damping.0[k],
                tangential_damping_ratio: self.tangential_damping_ratio.0[k],
                friction: self.friction.0[k],
            };
            let (response, memory) = law.respond(&contact, &pair, L::Memory::load(&self.memory, k));
            // Lanes beyond the contacts of this block hold leftovers, whose results nobody may see.
            let or_nothing = |value: T| if k < used { value } else { T::ZERO };
            if turns_as_sphere::<T, L>() {
                memory.store(&mut self.memory, k);
            } else {
                let (couples, memory) = law.couples(&contact, &pair, &response, &bodies, memory);
                memory.store(&mut self.memory, k);
                for (lanes, torque) in self.spin.iter_mut().zip(couples.torques) {
                    for (lane, component) in lanes.iter_mut().zip(torque.to_array()) {
                        lane.0[k] = component;
                    }
                }
                if LEDGER {
                    self.ledger[5].0[lane] += or_nothing(couples.spent);
                }
            }
            let force = (normal * response.normal_force + response.tangential_force).to_array();
            for axis in 0..3 {
                self.difference[axis].0[k] = force[axis];
            }
            if turns_as_sphere::<T, L>() {
                let couple = normal.cross(response.tangential_force).to_array();
                for axis in 0..3 {
                    self.velocity[axis].0[k] = couple[axis];
                }
            }
            if LEDGER {
                let energy = response.energy;
                let terms = [
                    energy.normal_elastic,
                    energy.tangential_elastic,
                    energy.normal_damping,
                    energy.tangential,
                    energy.sliding,
                ];
                for (sum, term) in self.ledger.iter_mut().zip(terms) {
                    sum.0[lane] += or_nothing(term);
                }
            }
        }
    }

    #[inline(always)]
    fn scatter<P: Precision<Real = T>, const HAS_QUADS: bool>(
        &mut self,
        waiting: &Waiting,
        slab: &mut Slab<T, L::Memory>,
        grains: SharedGrains<P>,
    ) {
        let pairs = waiting.pairs();
        self.remember::<P, HAS_QUADS>(waiting.places(), slab);
        if !turns_as_sphere::<T, L>() {
            #[cfg(target_arch = "x86_64")]
            if HAS_QUADS {
                let [fx, fy, fz] = &mut self.difference;
                let [[ax, ay, az], [bx, by, bz]] = &mut self.spin;
                let scattered = in_quads!(P, Q => {
                    let forces = [quads::start(fx), quads::start(fy), quads::start(fz)];
                    let first = [quads::start(ax), quads::start(ay), quads::start(az)];
                    let second = [quads::start(bx), quads::start(by), quads::start(bz)];
                    let loads = grains.loads().cast();
                    // SAFETY: as below.
                    unsafe {
                        quads::scatter_torques::<Q>(pairs, loads, forces, [first, second]);
                    }
                });
                if scattered.is_some() {
                    return;
                }
            }
            for (k, pair) in pairs.iter().enumerate() {
                let [i, j] = pair.grains();
                let at = |lanes: &[Lanes<T>; 3]| Vector::new(lanes[0].0[k], lanes[1].0[k], lanes[2].0[k]);
                let force: Vector<T> = at(&self.difference);
                grains.add_load(i, force, at(&self.spin[0]));
                grains.add_load(j, -force, at(&self.spin[1]));
            }
            return;
        }
        #[cfg(target_arch = "x86_64")]
        if HAS_QUADS {
            let scattered = in_quads!(P, Q => {
                let [fx, fy, fz] = &mut self.difference;
                let [cx, cy, cz] = &mut self.velocity;
                let [first, second] = &mut self.arm;
                let forces = [quads::start(fx), quads::start(fy), quads::start(fz)];
                let couples = [quads::start(cx), quads::start(cy), quads::start(cz)];
                let arms = [quads::start(first), quads::start(second)];
                // SAFETY: as in `gather`; no other slab works on these grains now.
                unsafe {
                    quads::scatter::<Q>(pairs, grains.loads().cast(), forces, couples, arms);
                }
            });
            if scattered.is_some() {
                return;
            }
        }
        for (k, pair) in pairs.iter().enumerate() {
            let [i, j] = pair.grains();
            let [fx, fy, fz] = &self.difference;
            let force = Vector::new(fx.0[k], fy.0[k], fz.0[k]);
            let [cx, cy, cz] = &self.velocity;
            let couple = Vector::new(cx.0[k], cy.0[k], cz.0[k]);
            grains.add_load(i, force, couple * -self.arm[0].0[k]);
            grains.add_load(j, -force, couple * -self.arm[1].0[k]);
        }
    }

    /// Sums begin anew.
    #[inline(always)]
    pub fn forget_sums(&mut self) {
        (self.ledger, self.depth) = Default::default();
    }

    /// Sums since they began.
    pub fn totals(&self, time_step: T) -> SlabSums {
        let total = |lanes: &Group<T>| lanes.0.iter().map(|value| value.to_f64()).sum::<f64>();
        let dt = time_step.to_f64();
        let [normal_elastic, tangential_elastic, normal_damping, tangential, sliding, turning] = &self.ledger;
        let ledger = ContactLedger {
            normal_elastic: total(normal_elastic),
            tangential_elastic: total(tangential_elastic),
            normal_damping: total(normal_damping) * dt,
            tangential: total(tangential) * dt,
            sliding: total(sliding) * dt,
            turning: total(turning) * dt,
            ..Default::default()
        };
        let is_too_deep = self.depth.0.iter().any(|&depth| depth > T::ZERO);
        SlabSums { ledger, is_too_deep }
    }
}
