//! The journal's file. What is appended survives the end of this process at once; a thread of its own sees to it that it survives a loss
//! of power, so that drawing never waits for a disk.

use super::super::failure::Failure;
use crate::drive::Ledger;
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::sync::mpsc::{Sender, channel};
use std::thread::JoinHandle;

pub(super) struct FileLedger {
    file: File,
    syncing: Option<(Sender<()>, JoinHandle<()>)>,
}

impl FileLedger {
    /// An empty journal.
    pub fn create(name: &str) -> Result<Self, Failure> {
        super::super::claims::check_not_input(name)?;
        File::create(name).and_then(Self::of).map_err(Failure::writing(name))
    }

    /// A journal that is continued.
    pub fn append_to(name: &str) -> Result<Self, Failure> {
        let file = OpenOptions::new().append(true).open(name).and_then(|mut file| {
            // The last line may have been cut off.
            file.write_all(b"\n")?;
            Ok(file)
        });
        file.and_then(Self::of).map_err(Failure::writing(name))
    }

    fn of(file: File) -> io::Result<Self> {
        let synced = file.try_clone()?;
        let (sender, receiver) = channel();
        let thread = std::thread::spawn(move || {
            while receiver.recv().is_ok() {
                // Requests that came meanwhile are done by the same sync.
                while receiver.try_recv().is_ok() {}
                let _ = synced.sync_data();
            }
        });
        Ok(Self { file, syncing: Some((sender, thread)) })
    }
}

impl Ledger for FileLedger {
    fn append(&mut self, line: &str) -> io::Result<()> {
        self.file.write_all(format!("{line}\n").as_bytes())
    }

    fn sync(&mut self) -> io::Result<()> {
        if let Some((sender, _)) = &self.syncing {
            let _ = sender.send(());
        }
        Ok(())
    }
}

impl Drop for FileLedger {
    fn drop(&mut self) {
        if let Some((sender, thread)) = self.syncing.take() {
            drop(sender);
            let _ = thread.join();
        }
    }
}
