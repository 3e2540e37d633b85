//! Schedules: how workers meet. All run the same stages and give the same bits.

mod fixed;
mod fork_join;
mod lockstep;
mod order;
mod peer_to_peer;
mod serial;
mod work;

pub use order::HandOut;
pub(crate) use work::Work;

use crate::team::Team;
use order::Order;

/// How workers meet (Holmes et al. 2011, Fig. 4).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Schedule {
    /// One worker, sub-domains in order: the reference.
    Serial,
    /// Every worker runs the whole time loop; a part ends when Dispatch completes (Fig. 4b).
    #[default]
    Lockstep,
    /// No meeting inside a bounded number of steps: a sub-domain goes on as soon as its
    /// neighbours have (Fig. 4c).
    PeerToPeer,
    /// One parallel loop a part, by rayon: the conventional master and slaves (Fig. 4a).
    ForkJoin,
    /// Equal shares, no Dispatch: what balance by events is compared with.
    Fixed,
}

impl Schedule {
    /// All schedules.
    pub const ALL: [Self; 5] =
        [Self::Serial, Self::Lockstep, Self::PeerToPeer, Self::ForkJoin, Self::Fixed];

    /// The name used on command lines.
    pub fn name(self) -> &'static str {
        match self {
            Self::Serial => "serial",
            Self::Lockstep => "lockstep",
            Self::PeerToPeer => "peer-to-peer",
            Self::ForkJoin => "fork-join",
            Self::Fixed => "fixed",
        }
    }
}

impl std::fmt::Display for Schedule {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

impl std::str::FromStr for Schedule {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|s| s.name() == name).ok_or_else(|| {
            let all: Vec<_> = Self::ALL.iter().map(|s| s.name()).collect();
            format!("no schedule {name:?}; there are {}", all.join(", "))
        })
    }
}

/// A team of workers and the protocol by which they meet.
pub(crate) struct Executor {
    schedule: Schedule,
    hand_out: HandOut,
    order: Order,
    team: Team,
    protocol: Protocol,
}

enum Protocol {
    Serial,
    Lockstep(Box<lockstep::Lockstep>),
    PeerToPeer(Box<peer_to_peer::PeerToPeer>),
    ForkJoin(fork_join::ForkJoin),
    Fixed(Box<fixed::Fixed>),
}

impl Executor {
    /// Starts the workers; `Serial` uses one whatever is asked for.
    pub fn new(schedule: Schedule, workers: usize, hand_out: HandOut) -> std::io::Result<Self> {
        let workers = match schedule {
            Schedule::Serial => 1,
            _ => workers,
        };
        if workers == 0 {
            let message = "a schedule needs at least one worker";
            return Err(std::io::Error::new(std::io::ErrorKind::InvalidInput, message));
        }
        let protocol = match schedule {
            Schedule::Serial => Protocol::Serial,
            Schedule::Lockstep => Protocol::Lockstep(lockstep::Lockstep::new(workers).into()),
            Schedule::PeerToPeer => {
                Protocol::PeerToPeer(peer_to_peer::PeerToPeer::new(workers).into())
            }
            Schedule::ForkJoin => Protocol::ForkJoin(fork_join::ForkJoin::new(workers)?),
            Schedule::Fixed => Protocol::Fixed(fixed::Fixed::new(workers).into()),
        };
        let order = Order::default();
        Ok(Self { schedule, hand_out, order, team: Team::new(workers)?, protocol })
    }

    pub fn schedule(&self) -> Schedule {
        self.schedule
    }

    /// The workers, for whole-domain stages.
    pub fn team(&mut self) -> &mut Team {
        &mut self.team
    }

    /// Runs all parts of all steps of `work` on all its sub-domains.
    pub fn run(&mut self, work: &dyn Work) {
        self.order.arrange(&self.hand_out, work.partition().len(), work.steps().start);
        let order = &self.order;
        match &mut self.protocol {
            Protocol::Serial => serial::run(work, order),
            Protocol::Lockstep(lockstep) => lockstep.run(&mut self.team, work, order),
            Protocol::PeerToPeer(peer) => peer.run(&mut self.team, work, order),
            Protocol::ForkJoin(fork_join) => fork_join.run(work, order),
            Protocol::Fixed(fixed) => fixed.run(&mut self.team, work, order),
        }
    }
}
