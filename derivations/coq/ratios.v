(* The forms of a flight from sigma = -S to sigma = -l S near a contact of order j, for every j:

     launch   v_c = b S^(j+1) (1 - l) P_j(l),   P_j(l) = (j+1) + j l + ... + l^j
     landing       b S^(j+1) (1 - l) Q_j(l),   Q_j(l) = 1 + 2 l + ... + (j+1) l^j

   Proved here: (1 - l) P_j falls with the slope -Q_j, so that a launch velocity has one first hit; l^(j+1) P_j/Q_j
   rises strictly, so that one ratio is invariant for each restitution; P_j(1) = Q_j(1), so that next to rest an
   impact multiplies flight times by r. *)

From Coq Require Import Reals Lra Lia.
Open Scope R_scope.

Fixpoint powers (j : nat) (l : R) : R :=
  match j with O => 1 | S k => powers k l + l ^ S k end.
Fixpoint P (j : nat) (l : R) : R :=
  match j with O => 1 | S k => P k l + powers (S k) l end.
Fixpoint Q (j : nat) (l : R) : R :=
  match j with O => 1 | S k => Q k l + INR (S (S k)) * l ^ S k end.

(* what the launch velocity is a multiple of *)
Definition D (j : nat) (l : R) : R := (1 - l) * P j l.

Lemma geometric j l : (1 - l) * powers j l = 1 - l ^ S j.
Proof.
  induction j as [|k IH]; [simpl; ring|].
  change (powers (S k) l) with (powers k l + l ^ S k).
  rewrite Rmult_plus_distr_l, IH. simpl. ring.
Qed.

Lemma D_next j l : D (S j) l = D j l + (1 - l ^ S (S j)).
Proof.
  unfold D. change (P (S j) l) with (P j l + powers (S j) l).
  rewrite Rmult_plus_distr_l, geometric. reflexivity.
Qed.

(* (P_j, Q_j) at the ends *)
Lemma P_at_0 j : P j 0 = INR (S j).
Proof.
  assert (one : forall k, powers k 0 = 1) by (induction k; simpl in *; [|rewrite IHk]; ring).
  induction j as [|k IH]; [reflexivity|].
  change (P (S k) 0) with (P k 0 + powers (S k) 0). rewrite IH, one, (S_INR (S k)). ring.
Qed.

Lemma equal_at_rest j : P j 1 = Q j 1.
Proof.
  assert (count : forall k, powers k 1 = INR (S k)).
  { induction k as [|k IH]; [reflexivity|].
    change (powers (S k) 1) with (powers k 1 + 1 ^ S k). rewrite IH, pow1, (S_INR (S k)). ring. }
  induction j as [|k IH]; [reflexivity|].
  change (P (S k) 1) with (P k 1 + powers (S k) 1).
  change (Q (S k) 1) with (Q k 1 + INR (S (S k)) * 1 ^ S k).
  rewrite IH, count, pow1. ring.
Qed.

Lemma powers_positive j l : 0 <= l -> 0 < powers j l.
Proof.
  intro H. induction j as [|k IH]; [simpl; lra|].
  change (powers (S k) l) with (powers k l + l ^ S k). assert (0 <= l ^ S k) by now apply pow_le. lra.
Qed.

Lemma P_positive j l : 0 <= l -> 0 < P j l.
Proof.
  intro H. induction j as [|k IH]; [simpl; lra|].
  change (P (S k) l) with (P k l + powers (S k) l). assert (K := powers_positive (S k) l H). lra.
Qed.

Lemma Q_positive j l : 0 <= l -> 0 < Q j l.
Proof.
  intro H. induction j as [|k IH]; [simpl; lra|].
  change (Q (S k) l) with (Q k l + INR (S (S k)) * l ^ S k).
  assert (0 <= INR (S (S k)) * l ^ S k) by (apply Rmult_le_pos; [apply pos_INR|now apply pow_le]). lra.
Qed.

(* d/dl (1 - l) P_j(l) = -Q_j(l) *)
Theorem launch_falls j l : derivable_pt_lim (D j) l (- Q j l).
Proof.
  induction j as [|k IH].
  - apply (derivable_pt_lim_ext (fun x => 1 - x)); [intro; unfold D; simpl; ring|].
    replace (- Q 0 l) with (0 - 1) by (simpl; ring).
    apply derivable_pt_lim_minus; [apply derivable_pt_lim_const|apply derivable_pt_lim_id].
  - apply (derivable_pt_lim_ext (fun x => D k x + (1 - x ^ S (S k)))); [intro; now rewrite D_next|].
    replace (- Q (S k) l) with (- Q k l + (0 - INR (S (S k)) * l ^ S k)) by (simpl; ring).
    apply derivable_pt_lim_plus; [exact IH|].
    apply derivable_pt_lim_minus; [apply derivable_pt_lim_const|apply derivable_pt_lim_pow].
Qed.

Lemma D_derivable j : derivable (D j).
Proof. intro l. exists (- Q j l). apply launch_falls. Qed.

Lemma D_continuous j l : continuity_pt (D j) l.
Proof. apply derivable_continuous_pt, D_derivable. Qed.

Theorem launch_decreases j l m : 0 <= l -> l < m -> D j m < D j l.
Proof.
  intros Hl Hm.
  destruct (MVT_cor2 (D j) (fun x => - Q j x) l m Hm (fun c _ => launch_falls j c)) as [c [E [Hc _]]].
  assert (0 < Q j c) by (apply Q_positive; lra). nra.
Qed.

Lemma powers_grow j l m : 0 <= l <= m -> powers j l <= powers j m.
Proof.
  intro H. induction j as [|k IH]; [simpl; lra|].
  change (powers k l + l ^ S k <= powers k m + m ^ S k). assert (l ^ S k <= m ^ S k) by now apply pow_incr. lra.
Qed.

Lemma P_grows j l m : 0 <= l <= m -> P j l <= P j m.
Proof.
  intro H. induction j as [|k IH]; [simpl; lra|].
  change (P k l + powers (S k) l <= P k m + powers (S k) m). assert (K := powers_grow (S k) l m H). lra.
Qed.

(* Q_j/l^j falls *)
Lemma Q_swaps j l m : 0 <= l <= m -> l ^ j * Q j m <= m ^ j * Q j l.
Proof.
  intros [H0 H]. induction j as [|k IH]; [simpl; lra|].
  change (Q (S k) m) with (Q k m + INR (S (S k)) * m ^ S k).
  change (Q (S k) l) with (Q k l + INR (S (S k)) * l ^ S k).
  assert (A : l * (l ^ k * Q k m) <= m * (m ^ k * Q k l)).
  { apply Rmult_le_compat; try assumption.
    apply Rmult_le_pos; [now apply pow_le|]. left. apply Q_positive. lra. }
  simpl (l ^ S k) in *. simpl (m ^ S k) in *. nra.
Qed.

(* l^(j+1) P_j/Q_j rises strictly: its value at the invariant ratio is the restitution *)
Theorem restitution_rises j l m : 0 <= l -> l < m -> l ^ S j * P j l * Q j m < m ^ S j * P j m * Q j l.
Proof.
  intros H0 H.
  assert (QL := Q_positive j l H0). assert (QM : 0 < Q j m) by (apply Q_positive; lra).
  assert (PL := P_positive j l H0). assert (PG : P j l <= P j m) by (apply P_grows; lra).
  assert (SW : l ^ j * Q j m <= m ^ j * Q j l) by (apply Q_swaps; lra).
  assert (MJ : 0 < m ^ j) by (apply pow_lt; lra).
  assert (W : 0 < m ^ j * Q j l) by now apply Rmult_lt_0_compat.
  simpl (l ^ S j). simpl (m ^ S j).
  apply Rle_lt_trans with (l * P j l * (m ^ j * Q j l)).
  - replace (l * l ^ j * P j l * Q j m) with (l * P j l * (l ^ j * Q j m)) by ring.
    apply Rmult_le_compat_l; [apply Rmult_le_pos; lra|exact SW].
  - replace (m * m ^ j * P j m * Q j l) with (m * P j m * (m ^ j * Q j l)) by ring.
    apply Rmult_lt_compat_r; [exact W|nra].
Qed.
