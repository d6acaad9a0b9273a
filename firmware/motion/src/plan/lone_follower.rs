//! A follower whose plans are handed over by the same hand that follows them: for benches and tests.

use super::Plan;
use super::follower::{PlanFollower, Stale};
use super::slots::{PlanHandle, PlanReceiver, PlanSender, PlanSlots};
use core::ops::{Deref, DerefMut};

/// See the module.
pub struct LoneFollower<'a> {
    follower: PlanFollower,
    sender: PlanSender<'a>,
    plans: PlanReceiver<'a>,
}

impl<'a> LoneFollower<'a> {
    /// At rest at the origin.
    pub fn new(slots: &'a mut PlanSlots) -> Self {
        let (sender, plans) = slots.split();
        Self {
            follower: PlanFollower::default(),
            sender,
            plans,
        }
    }

    /// Hands a plan over and takes it.
    pub fn accept(&mut self, plan: &Plan) -> Result<(), Stale> {
        let handle = self.hand_over(plan).ok_or(Stale)?;
        self.take(&handle)
    }

    /// Hands a plan over, to be taken; `None` while another one is.
    pub fn hand_over(&mut self, plan: &Plan) -> Option<PlanHandle> {
        self.sender.hand_over(plan)
    }

    /// Takes a plan, or gives its slot back.
    pub fn take(&mut self, handle: &PlanHandle) -> Result<(), Stale> {
        let taken = self.follower.accept(handle, self.plans);
        if taken.is_err() {
            self.plans.give_back(handle.slot);
        }
        taken
    }

    /// One tick on.
    #[inline]
    pub fn advance(&mut self) {
        self.follower.advance(self.plans);
    }
}

impl Deref for LoneFollower<'_> {
    type Target = PlanFollower;

    fn deref(&self) -> &PlanFollower {
        &self.follower
    }
}

impl DerefMut for LoneFollower<'_> {
    fn deref_mut(&mut self) -> &mut PlanFollower {
        &mut self.follower
    }
}
